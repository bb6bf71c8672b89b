#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "limn/refine/patterns/table.h"

namespace limn {

/// log2 of the segments of a face's sides, in any order.
using PatternSides = std::array<std::uint8_t, 3>;

/// Minimal patterns as they lie on faces with these sides, one after the other, unsorted sides too: what methods store
/// that turn no pattern. No mirrored triangles. Cost: that of pattern_table(). \pre no level exceeds kMaxPatternLevel
PatternTable patterns_of_sides(std::span<const PatternSides> sides);

/// [i, j, k] for all i, j, k up to max_level, the last changing fastest: pattern (i·N + j)·N + k, N = max_level + 1.
std::vector<PatternSides> all_sides(int max_level);

/// [m, m, m] for all m up to max_level.
std::vector<PatternSides> uniform_sides(int max_level);

}  // namespace limn
