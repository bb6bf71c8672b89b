#pragma once

#include "limn/refine/patterns/pattern.h"

namespace limn {

/// A pattern with the vertices of its border and none inside. \pre sides descend
Pattern pattern_border(const PatternConfig& config);

}  // namespace limn
