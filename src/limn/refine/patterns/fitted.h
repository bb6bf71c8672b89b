#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "limn/refine/patterns/pattern.h"

namespace limn {

/// Twice the area of a triangle of pattern vertices of one level, in units of 1/4^level of the parameter triangle's:
/// positive when it is wound as (corner 0, corner 1, corner 2). Exact.
inline std::int64_t twice_area(const PatternVertex& a, const PatternVertex& b, const PatternVertex& c) {
  return std::int64_t{b.j - a.j} * (c.k - a.k) - std::int64_t{b.k - a.k} * (c.j - a.j);
}

/// The triangle in which a minimal pattern is laid out: sides as long as they have segments, so that all segments are
/// equally long there. Where one side outgrows the other two, it is as long as makes the angle opposite 120°:
/// c² = a² + b² + ab. Squared lengths are integers, and so are the products below.
struct FittedTriangle {
  std::array<std::int64_t, 3> squared;  ///< lengths of sides 0, 1, 2

  /// (from − at)·(to − at), times 2·4^level. Exact: below 2^38 for levels up to 8.
  std::int64_t dot_at(const PatternVertex& at, const PatternVertex& from, const PatternVertex& to) const {
    const std::int64_t aj = from.j - at.j;
    const std::int64_t ak = from.k - at.k;
    const std::int64_t bj = to.j - at.j;
    const std::int64_t bk = to.k - at.k;
    return 2 * squared[0] * aj * bj + 2 * squared[2] * ak * bk +
           (squared[0] + squared[2] - squared[1]) * (aj * bk + ak * bj);
  }
  /// dot_at() / twice_area() over this is a cotangent.
  double area_scale() const;
  /// The cotangent of a triangle's smallest angle. \pre the triangle has positive area
  double sharpest_cotangent(const PatternVertex& a, const PatternVertex& b, const PatternVertex& c) const;
};

/// \pre sides descend
FittedTriangle fit_triangle(const std::array<std::uint8_t, 3>& sides);

/// The smallest angle of each triangle of a minimal pattern on its fitted triangle.
std::vector<double> smallest_angles_rad(const Pattern& pattern);

}  // namespace limn
