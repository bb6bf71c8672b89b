#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace limn::test {

/// An empty folder of a test's own, removed with all it holds when the test ends.
class TempFolder {
 public:
  TempFolder();
  ~TempFolder();
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(std::string_view name) const { return path_ / name; }
  /// Writes a file into it and gives its path.
  std::filesystem::path write(std::string_view name, std::string_view content) const;

 private:
  std::filesystem::path path_;
};

/// A whole file as a string; fails the test when it cannot be read.
std::string slurp(const std::filesystem::path& path);

}  // namespace limn::test
