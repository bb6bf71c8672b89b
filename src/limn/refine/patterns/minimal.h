#pragma once

#include "limn/refine/patterns/pattern.h"

namespace limn {

/// make_pattern() of PatternFamily::kMinimal for sides i ≥ j ≥ k.
///
/// A pattern with k > 0 that is large enough is that of (i−1, j−1, k−1) with every triangle cut in four, which keeps
/// its shape and its share of points inside; the others are Delaunay triangulations of the fitted triangle with points
/// of the grid added where they improve it (docs/patterns.md).
Pattern make_minimal_pattern(const std::array<std::uint8_t, 3>& sides);

}  // namespace limn
