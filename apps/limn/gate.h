#pragma once

#include <span>
#include <string>
#include <string_view>

#include "limn/base/result.h"

namespace limn::cli {

/// A condition under which a verb ends with exit code 5: "mean_px>0.5".
struct Gate {
  std::string text;
  std::size_t figure = 0;  ///< which of the verb's figures
  bool (*holds)(double value, double limit) = nullptr;
  double limit = 0;
};

/// One of the figures, then one of > >= < <=, then a number; blanks between them are allowed.
/// \param figures  two names or more, none the beginning of a later one
Result<Gate> parse_gate(std::string_view text, std::span<const std::string_view> figures);

/// \param values  of the figures, in their order
bool trips(const Gate& gate, std::span<const double> values);

}  // namespace limn::cli
