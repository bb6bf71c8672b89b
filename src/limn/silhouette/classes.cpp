#include "limn/silhouette/classes.h"

#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>

namespace limn {
namespace {

template <class Keep>
std::vector<EdgeId> select_edges(const Topology& topology, const Keep& keep) {
  std::vector<EdgeId> selected;
  for (std::size_t e = 0; e < topology.edge_count(); ++e) {
    if (keep(e)) selected.push_back(static_cast<EdgeId>(e));
  }
  return selected;
}

}  // namespace

std::vector<EdgeId> boundary_edges(const Topology& topology) {
  return select_edges(topology, [&](std::size_t e) { return topology.edge_class[e] == EdgeClass::kBoundary; });
}

std::vector<EdgeId> non_manifold_edges(const Topology& topology) {
  return select_edges(topology, [&](std::size_t e) {
    return topology.edge_class[e] == EdgeClass::kNonManifold || topology.edge_class[e] == EdgeClass::kInconsistent;
  });
}

std::vector<EdgeId> crease_edges(const Topology& topology, std::span<const Vec3> normals, float angle_rad) {
  assert(normals.size() == topology.face_count());
  return select_edges(topology, [&](std::size_t e) {
    if (topology.edge_class[e] != EdgeClass::kManifold) return false;
    const DVec3 a = normals[topology.edges[e].face[0]];
    const DVec3 b = normals[topology.edges[e].face[1]];
    if (a == DVec3(0.0) || b == DVec3(0.0)) return false;
    // From sine and cosine: the cosine alone cannot tell small angles apart.
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) > double{angle_rad};
  });
}

}  // namespace limn
