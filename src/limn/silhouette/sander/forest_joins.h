#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "limn/base/progress.h"
#include "limn/base/result.h"
#include "limn/silhouette/sander/culling_frame.h"
#include "limn/silhouette/sander/paper_forest.h"

namespace limn {

/// An edge as the greedy construction sees it.
struct JoinEdge {
  FaceId face[2];
  DVec3 middle;  ///< in the culling frame
};

/// A tree while it grows: lists as links, so that joining two takes constant time.
struct JoinNode {
  static constexpr std::uint32_t kNone = 0xffffffffu;
  std::uint32_t first_edge = kNone, last_edge = kNone;
  std::uint32_t first_child = kNone, last_child = kNone;
  std::uint32_t next_sibling = kNone;
};

/// What the greedy construction made.
struct JoinedForest {
  std::vector<JoinNode> nodes;
  std::vector<std::uint32_t> next_edge;  ///< beside the edges: the next in the same node
  std::vector<std::uint32_t> roots;      ///< nodes, ascending
};

/// buildOptimalForest of Sander et al. 2000, section 5, "Tree Construction".
///
/// \param planes  of every face, in the culling frame
/// \param links   pairs of edges that may be joined; each pair once, smaller index first
/// The cost of a root telescopes: ka + Σ P(n)·(ke|n.E| + ka|n.C|) over the nodes n of its tree, so that a join's
/// decrease depends on the two roots and on the probability of their union alone. Every candidate's decrease is exact
/// at any time: when two roots are joined, those of all links of the new root are computed anew.
/// Errors: kCancelled.
Result<JoinedForest> join_forest(std::span<const FramedPlane> planes, std::span<const JoinEdge> edges,
                                 std::span<const std::pair<std::uint32_t, std::uint32_t>> links,
                                 const PaperForestOptions& options, const Progress& progress);

}  // namespace limn
