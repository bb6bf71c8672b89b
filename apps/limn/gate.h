#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "limn/base/result.h"

namespace limn::cli {

/// A condition under which a verb ends with exit code 5: "mean_px>0.5".
struct Gate {
  std::string text;
  std::size_t figure = 0;  ///< which of the verb's figures
  bool (*holds)(double value, double limit) = nullptr;
  double limit = 0;
};

/// One of the figures, then one of > >= < <=, then a number, a share where % follows; blanks between them are allowed.
/// \param figures  two names or more, none the beginning of a later one
Result<Gate> parse_gate(std::string_view text, std::span<const std::string_view> figures);

/// The texts of those that trip. \param values  of the figures, in their order
std::vector<std::string> tripped(std::span<const Gate> gates, std::span<const double> values);

}  // namespace limn::cli
