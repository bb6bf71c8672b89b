#pragma once

#include <cstddef>

#include "limn/mesh/mesh.h"

namespace limn::bench {

/// Reduces a mesh to `faces` faces with meshoptimizer; what remains keeps positions and normals of the original's.
///
/// Vertices are welded by position first, so that no seam of a file hinders. Normals are the mesh's own, or
/// crease_normals() of the original where it has none. At a vertex where the original's normals are split, a corner
/// takes the one nearest to its face's normal. A few more faces may remain than asked for where nothing else can be
/// removed without changing the surface's topology. Other attributes, materials and tags are dropped. Same input, same
/// bits. \pre mesh has at least one face, every index is in range, every coordinate finite
Mesh reduce(const Mesh& mesh, std::size_t faces, float crease_angle_rad);

}  // namespace limn::bench
