#pragma once

#include "limn/refine/patterns/pattern.h"

namespace limn {

/// make_pattern() of PatternFamily::kNested: the grid P_m, each border triangle fanned from the corner opposite its
/// first side that has points; what is left of the other sides falls to the fan's first and last triangle.
Pattern make_nested_pattern(const PatternConfig& config);

}  // namespace limn
