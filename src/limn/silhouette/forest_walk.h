#pragma once

#include "limn/silhouette/paper_forest.h"

namespace limn {

/// One past the last of the edges of a node and its descendants, which begin at node.edge_begin.
inline std::uint32_t end_of_edges_below(const PaperForest& forest, const PaperForestNode& node) {
  return node.skip < forest.nodes.size() ? forest.nodes[node.skip].edge_begin
                                         : static_cast<std::uint32_t>(forest.edges.size());
}

/// Tests one run of edges, adding those that are silhouettes.
inline void test_forest_edges(const PaperForest& forest, std::uint32_t begin, std::uint32_t end, const Eye& eye,
                              std::vector<EdgeId>& edges) {
  for (std::uint32_t i = begin; i < end; ++i) {
    const PaperForestEdge& edge = forest.edges[i];
    if (faces_eye(forest.planes[edge.face[0]], eye) != faces_eye(forest.planes[edge.face[1]], eye))
      edges.push_back(edge.edge);
  }
}

/// Searches the forest with any test of a node: culled(index of the node) says whether all its faces look one way.
template <class Culled>
SearchCounts walk_forest(const PaperForest& forest, const Eye& eye, std::vector<EdgeId>& edges,
                         const Culled& culled) {
  edges.clear();
  SearchCounts counts;
  const auto node_count = static_cast<std::uint32_t>(forest.nodes.size());
  for (std::uint32_t i = 0; i < node_count;) {
    const PaperForestNode& node = forest.nodes[i];
    ++counts.nodes;
    if (culled(i)) {
      i = node.skip;
      continue;
    }
    counts.edges += node.edge_end - node.edge_begin;
    test_forest_edges(forest, node.edge_begin, node.edge_end, eye, edges);
    ++i;
  }
  return counts;
}

}  // namespace limn
