#pragma once

#include <vector>

#include "limn/base/vec.h"
#include "limn/mesh/mesh.h"

namespace limn::bake_detail {

/// The tangents of a mesh as MikkTSpace gives them (Mikkelsen 2008, "Simulation of Wrinkled Surfaces Revisited"), the
/// standard by which glTF viewers read normal maps: one a corner, 3 · face + corner; xyz of unit length along growing
/// u, w +1 or −1 so that w · cross(normal, tangent) runs along growing v.
///
/// Corners are joined where position, normal and texture coordinates are equal, in bits but for the sign of zero.
/// Around such a point, faces that share edges and wind alike in the picture form a group, and a group's tangent is the
/// mean of its faces' own, projected along the normal and weighted by the angle at the corner. Faces without extent in
/// the picture join either kind of group and add nothing; faces without extent in space take the tangent of another
/// corner at their point. Cost: about 0.5 µs a face, one thread. \pre the mesh has uvs, and `normals` one unit normal a
/// corner Compared with the reference implementation: docs/baking.md.
std::vector<Vec4> mikk_tangents(const Mesh& mesh, const CornerAttribute<Vec3>& normals);

/// A frame at a point of a face: what a fragment stage interpolates and does not normalize.
struct TangentFrame {
  Vec3 tangent{1, 0, 0};
  Vec3 bitangent{0, 1, 0};
  Vec3 normal{0, 0, 1};
};

/// The frame at corner weights 1 − u − v, u, v: tangents and normals interpolated linearly, the bitangent made from
/// both.
TangentFrame interpolated_frame(const Vec4 (&tangents)[3], const Vec3 (&normals)[3], float u, float v);

/// The unit vector t with t.x · tangent + t.y · bitangent + t.z · normal along n: what a normal map stores. (0, 0, 1)
/// where the frame spans no space.
Vec3 into_frame(const TangentFrame& frame, const Vec3& n);

/// What a viewer makes of it: the sum above, of unit length.
Vec3 out_of_frame(const TangentFrame& frame, const Vec3& t);

}  // namespace limn::bake_detail
