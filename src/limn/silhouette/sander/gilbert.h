#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "limn/base/vec.h"

namespace limn {

/// Some of a set of points, at most four, whose convex hull is as near to the origin as that of all.
struct ClosestSimplex {
  DVec3 point{0.0};                      ///< the point of the hull closest to the origin; 0 when that is inside
  std::array<std::uint32_t, 4> index{};  ///< the points whose convex combination it is
  int count = 0;                         ///< how many: 1 to 3 outside the hull, up to 4 inside, 0 for an empty set
  bool contains_origin = true;           ///< whether the origin lies in the hull, or within 1e-9 of it
};

/// Finds the point of the convex hull of `points` that is closest to the origin: Gilbert's algorithm with simplices.
///
/// Of a set of unit normals the point's direction is the axis of the widest open cone in which all normals' faces look
/// one way: the normal furthest from it is acos(|point|) away, as are all of the simplex, and the cone's half angle is
/// asin(|point|). There is none when the hull contains the origin.
/// \param start  indices of points to begin with, at most four: those of a previous answer save passes
/// \pre points are finite and about of unit length
/// Cost: a few passes over the points (2 to 6 in practice, never more than 64). Same input, same bits.
/// Gilbert, Johnson and Keerthi 1988; Sander et al. 2000, section 5, "Anchored Cone Construction".
ClosestSimplex closest_to_origin(std::span<const DVec3> points, std::span<const std::uint32_t> start = {});

}  // namespace limn
