#pragma once

#include <cstddef>
#include <vector>

#include "limn/silhouette/sander/paper_forest.h"

namespace limn {

/// One past the last of the edges of a node and its descendants, which begin at node.edge_begin.
inline std::uint32_t end_of_edges_below(const PaperForest& forest, const PaperForestNode& node) {
  return node.skip < forest.nodes.size() ? forest.nodes[node.skip].edge_begin
                                         : static_cast<std::uint32_t>(forest.edges.size());
}

/// Edges found so far, in the caller's vector: what it held before is overwritten, not cleared and filled again.
class FoundEdges {
 public:
  explicit FoundEdges(std::vector<EdgeId>& edges) : edges_(edges) {}
  ~FoundEdges() { edges_.resize(count_); }
  FoundEdges(const FoundEdges&) = delete;
  FoundEdges& operator=(const FoundEdges&) = delete;

  /// Room for `more` edges; advance() says how many of them were written.
  EdgeId* room(std::size_t more) {
    if (edges_.size() < count_ + more) edges_.resize(2 * (count_ + more));
    return edges_.data() + count_;
  }
  void advance(std::size_t written) { count_ += written; }

 private:
  std::vector<EdgeId>& edges_;
  std::size_t count_ = 0;
};

/// Tests a node's own edges, adding those that are silhouettes.
inline void test_forest_edges(const PaperForest& forest, const PaperForestNode& node, const Eye& eye,
                              FoundEdges& found) {
  EdgeId* const room = found.room(node.edge_end - node.edge_begin);
  std::size_t count = 0;
  // Without a branch: about every third edge tested is found, which no processor can predict.
  for (std::uint32_t i = node.edge_begin; i < node.edge_end; ++i) {
    const PaperForestEdge& edge = forest.edges[i];
    room[count] = edge.edge;
    count += faces_eye(forest.planes[edge.face[0]], eye) != faces_eye(forest.planes[edge.face[1]], eye);
  }
  found.advance(count);
}

/// Searches the forest with any test of a node: culled(index of the node) says whether all its faces look one way.
template <class Culled>
SearchCounts walk_forest(const PaperForest& forest, const Eye& eye, std::vector<EdgeId>& edges, const Culled& culled) {
  SearchCounts counts;
  FoundEdges found(edges);
  const auto node_count = static_cast<std::uint32_t>(forest.nodes.size());
  for (std::uint32_t i = 0; i < node_count;) {
    const PaperForestNode& node = forest.nodes[i];
    ++counts.nodes;
    if (culled(i)) {
      i = node.skip;
      continue;
    }
    counts.edges += node.edge_end - node.edge_begin;
    test_forest_edges(forest, node, eye, found);
    ++i;
  }
  return counts;
}

}  // namespace limn
