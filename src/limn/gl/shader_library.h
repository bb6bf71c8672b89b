#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "limn/base/result.h"

namespace limn::gl {

/// Where shader texts come from: those built into limn, or the files of a folder, read anew each time they are asked
/// for.
class ShaderLibrary {
 public:
  /// \param folder  empty: the built-in texts
  explicit ShaderLibrary(std::filesystem::path folder = {}) : folder_(std::move(folder)) {}

  /// A shader's text with every line `#include "NAME"` replaced by that shader's (each at most once) and the `defines`
  /// ("NAME VALUE") behind its #version line.
  /// Errors: kUnreadable for a name that is not there.
  Result<std::string> source(std::string_view name, const std::vector<std::string>& defines = {}) const;

 private:
  Result<std::string> file(std::string_view name) const;
  Result<void> expand(std::string_view name, std::vector<std::string>& seen, std::string& text) const;
  std::filesystem::path folder_;
};

}  // namespace limn::gl
