#pragma once

#include <vector>

#include "limn/mesh/mesh.h"
#include "limn/mesh/topology.h"

namespace limn {

/// Unit normal of each face, from its winding; (0,0,0) for a face without area. Computed in double.
std::vector<Vec3> face_normals(const Mesh& mesh);

/// Corner normals: the mean of the face normals around each vertex, weighted by angle times root of area, split where
/// neighbouring faces meet at more than crease_angle_rad, and at boundary, inconsistent and non-manifold edges only
/// where the fan ends.
///
/// Angle 0 makes every face flat, π or more makes everything smooth. Values are shared: one a smooth fan.
/// Same bits for any number of threads. \pre topology was built from this mesh
CornerAttribute<Vec3> crease_normals(const Mesh& mesh, const Topology& topology, float crease_angle_rad);

}  // namespace limn
