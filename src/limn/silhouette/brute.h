#pragma once

#include <span>
#include <vector>

#include "limn/mesh/topology.h"
#include "limn/silhouette/facing.h"

namespace limn {

/// Finds every silhouette edge by testing all of them: the oracle that every other extractor equals.
///
/// An edge is returned when it has two faces (EdgeClass::kManifold or kInconsistent) and exactly one is seen from the
/// front (facing.h). Boundary and non-manifold edges are never returned here; see boundary_edges(),
/// non_manifold_edges() and Topology::edge_class.
///
/// \param topology  edges and faces of the mesh
/// \param planes    one per face, from face_planes()
/// \param eye       a point in the mesh's space, or a direction towards the viewer when orthographic
/// \param edges     cleared, then filled with edge ids in ascending order
/// \pre  planes.size() == topology.face_count()
/// Cost: one plane test a face and one comparison an edge; allocates only while `edges` grows.
/// Same result for any number of threads. Sander et al. 2000, section 5.
void extract_silhouette_brute(const Topology& topology, std::span<const Plane> planes, const Eye& eye,
                              std::vector<EdgeId>& edges);

}  // namespace limn
