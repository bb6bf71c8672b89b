#pragma once

#include <string>
#include <string_view>

#include "limn/base/result.h"
#include "limn/compare/outline.h"

namespace limn::cli {

/// A condition under which `compare` ends with exit code 5: "mean_px>0.5".
struct Gate {
  std::string text;
  double OutlineError::*figure = &OutlineError::mean_px;
  bool (*holds)(double value, double limit) = nullptr;
  double limit = 0;
};

/// One of mean_px, p95_px, max_px, iou, then one of > >= < <=, then a number; blanks between them are allowed.
Result<Gate> parse_gate(std::string_view text);

bool trips(const Gate& gate, const OutlineError& error);

}  // namespace limn::cli
