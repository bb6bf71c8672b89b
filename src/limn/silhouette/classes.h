#pragma once

#include <span>
#include <vector>

#include "limn/mesh/topology.h"

namespace limn {

/// The edges with one face only, ascending.
std::vector<EdgeId> boundary_edges(const Topology& topology);

/// The non-manifold and inconsistent edges, ascending.
std::vector<EdgeId> non_manifold_edges(const Topology& topology);

/// The manifold edges whose faces' normals differ by more than angle_rad, ascending. Faces without area make no crease.
/// \pre normals is face_normals() of the mesh; 0 <= angle_rad <= π
std::vector<EdgeId> crease_edges(const Topology& topology, std::span<const Vec3> normals, float angle_rad);

}  // namespace limn
