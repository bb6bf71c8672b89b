#pragma once

#include <span>
#include <string>
#include <string_view>

#include "limn/base/result.h"

namespace limn::cli {

/// "FIGURE>LIMIT": what --fail-if takes.
struct Condition {
  std::string text;        ///< as typed
  std::size_t figure = 0;  ///< which of the names
  bool (*compare)(double value, double limit) = nullptr;
  double limit = 0;

  bool holds(double value) const { return compare(value, limit); }
};

/// One of the names, then one of > >= < <=, then a number, divided by 100 where % follows; blanks between them are
/// allowed. \param example  for the error: "mean_px>0.5". \pre no name begins another
Result<Condition> parse_condition(std::string_view text, std::span<const std::string_view> names,
                                  std::string_view example);

}  // namespace limn::cli
