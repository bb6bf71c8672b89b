#pragma once

#include <span>

#include "limn/bake/face_tree.h"
#include "limn/mesh/mesh.h"

namespace limn::asset {

/// How far a surface lies from another at most.
struct SurfaceDistance {
  double reached = 0;  ///< a point of the surface lies that far
  double bound = 0;    ///< no point of it lies further
};

/// The largest distance of a point of the surface from the nearest point of the reference: a bound that holds for every
/// point, not for samples only.
///
/// Distances change by no more than a point moves: a triangle lies within the distance of its centroid and the way from
/// there to its farthest corner. Triangles that may lie more than a fifth beyond the largest distance known are cut
/// into four, until none does; or until 32 a face were looked at, as happens where the surface lies on the reference
/// nearly everywhere: the farthest are cut first, and the bound is as good as the pieces are small then.
///
/// Where the surface encloses the reference, this is also how far its outline can lie from the reference's outline,
/// from any viewpoint outside of both (docs/asset.md).
///
/// Cost: at most 32 nearest points a face, and 100,000; memory in proportion. Same result for any number of threads.
/// \pre both have faces
SurfaceDistance distance_from(const Mesh& surface, const bake_detail::FaceTree& reference);

}  // namespace limn::asset
