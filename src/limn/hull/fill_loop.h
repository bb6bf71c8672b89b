#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "limn/base/vec.h"

namespace limn {

/// Triangles over a loop of corners 0 … n-1; n stands for a point in the middle, where one was needed.
struct LoopFilling {
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< each runs round as the loop does
  bool has_middle = false;
  Vec3 middle{0};
};

/// Fills a closed loop of corners with triangles that have its corners as vertices: those of least area, and among like
/// ones of short sides, for small loops (dynamic programming, cubic in the corners, at most 40); corners cut off one
/// after another, short cuts first, those that turn against the loop last, for larger ones (n log n).
///
/// \param corners    three or more; the loop may be bent in space
/// \param forbidden  pairs of corners (lower first, ascending) that must not be joined, because an edge joins them
/// already A point in the middle of what is left is added where forbidden pairs leave no other way. Same bits on every
/// run.
LoopFilling fill_loop(std::span<const Vec3> corners,
                      std::span<const std::pair<std::uint32_t, std::uint32_t>> forbidden);

}  // namespace limn
