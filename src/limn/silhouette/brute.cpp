#include "limn/silhouette/brute.h"

#include <cassert>

namespace limn {

void extract_silhouette_brute(const Topology& topology, std::span<const Plane> planes, const Eye& eye,
                              std::vector<EdgeId>& edges) {
  assert(planes.size() == topology.face_count());
  std::vector<std::uint8_t> facing;
  classify_faces(planes, eye, facing);
  edges.clear();
  for (std::size_t e = 0; e < topology.edge_count(); ++e) {
    const EdgeClass edge_class = topology.edge_class[e];
    if (edge_class != EdgeClass::kManifold && edge_class != EdgeClass::kInconsistent) continue;
    const Edge& edge = topology.edges[e];
    if (facing[edge.face[0]] != facing[edge.face[1]]) edges.push_back(static_cast<EdgeId>(e));
  }
}

}  // namespace limn
