#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "limn/base/progress.h"
#include "limn/base/result.h"
#include "limn/mesh/topology.h"
#include "limn/silhouette/sander/anchored_cone.h"

namespace limn {

/// A node of the search forest. Nodes lie in the order of a walk from the roots: a node's first child follows it, and
/// its edges come before those of its descendants.
struct PaperForestNode {
  StoredCone cone;           ///< of the faces at its edges and at those of all its descendants
  std::uint32_t edge_begin;  ///< its own edges in PaperForest::edges
  std::uint32_t edge_end;
  std::uint32_t skip;  ///< the node that follows when this one is culled: one past its last descendant
};

/// An edge that can be a silhouette.
struct PaperForestEdge {
  EdgeId edge;
  std::uint32_t face[2];  ///< into PaperForest::planes
};

/// The search forest of Sander et al. 2000, section 5: finds silhouette edges without testing all.
/// Immutable once built; may be searched by several threads at once.
struct PaperForest {
  CullingFrame frame;
  std::vector<PaperForestNode> nodes;
  std::vector<PaperForestEdge> edges;  ///< every edge with two faces, once; those below a node are consecutive
  std::vector<Plane> planes;           ///< of the faces, in the order in which the edges need them
  std::size_t root_count = 0;
};

/// What the paper leaves open, and its constants.
struct PaperForestOptions {
  double cone_cost = 4.0 / 3.0;    ///< ka/ke: what testing a node costs when testing an edge costs 1. > 0
  double viewpoint_radius = 10.0;  ///< of the sphere U of viewpoints, in radii of the mesh. >= 1; may be infinite
  /// Also links edges apart whose normals differ by less than this (the paper's footnote 3): seldom worth its time.
  /// 0 to 1; 0: off. Each edge is linked with eight such edges at most, not with all.
  double similar_normals_rad = 0.0;
};

/// Builds the forest bottom-up and greedily: every edge begins as a root; the join of two linked roots that lowers the
/// predicted cost of a search most is done, until none lowers it. Joins are parent, adopt (either way) and merge.
///
/// Edges with two faces take part (manifold and inconsistent). Clusters with a face without area are never culled.
/// \pre planes is face_planes(mesh), topology is build_topology(mesh)
/// Cost: about 0.1 ms and 1 kB an edge (docs/paper-forest.md). Same bits for any number of threads.
/// Errors: kInvalidArgument for options out of range; kCancelled.
Result<PaperForest> build_paper_forest(const Mesh& mesh, const Topology& topology, std::span<const Plane> planes,
                                       const PaperForestOptions& options = {}, const Progress& progress = {});

/// What a search cost, as the paper counts it.
struct SearchCounts {
  std::size_t edges = 0;  ///< tested
  std::size_t nodes = 0;  ///< visited, culled or not
  /// In units of one edge's test.
  double edge_equivalents(double cone_cost = 4.0 / 3.0) const {
    return static_cast<double>(edges) + cone_cost * static_cast<double>(nodes);
  }
};

/// Finds the same edges as extract_silhouette_brute(), whatever the eye, in the forest's order (not sorted).
/// \param edges  cleared, then filled
/// Cost: one culls() a node visited, two faces_eye() an edge tested. Allocates only while `edges` grows.
SearchCounts extract_silhouette_forest(const PaperForest& forest, const Eye& eye, std::vector<EdgeId>& edges);

}  // namespace limn
