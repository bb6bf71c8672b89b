#pragma once

#include <string_view>

#include "limn/base/result.h"
#include "limn/compare/outline.h"

#include "condition.h"

namespace limn::cli {

/// A condition under which `compare` ends with exit code 5: "mean_px>0.5".
using Gate = Condition;

/// A condition on mean_px, p95_px, max_px or iou.
Result<Gate> parse_gate(std::string_view text);

bool trips(const Gate& gate, const OutlineError& error);

}  // namespace limn::cli
