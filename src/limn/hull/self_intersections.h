#pragma once

#include <span>
#include <vector>

#include "limn/base/vec.h"
#include "limn/mesh/ids.h"

namespace limn {

/// Two faces that intersect, the lower id first.
struct FacePair {
  FaceId a, b;
  friend bool operator==(const FacePair& x, const FacePair& y) { return x.a == y.a && x.b == y.b; }
  friend bool operator<(const FacePair& x, const FacePair& y) { return x.a != y.a ? x.a < y.a : x.b < y.b; }
};

/// Every pair of faces that have a point in common besides the corners and sides they share, ascending. Shared is what
/// has equal coordinates; touching counts, faces with the same three corners count (triangle_intersection.h).
/// Exact. Cost: n log n, plus the pairs whose boxes meet. Uses all threads; same result for any number of them.
/// \pre indices in range, coordinates finite
std::vector<FacePair> self_intersections(std::span<const Vec3> positions, std::span<const Triangle> faces);

}  // namespace limn
