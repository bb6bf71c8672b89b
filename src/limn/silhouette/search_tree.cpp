#include "limn/silhouette/search_tree.h"

#include <cassert>

#include "limn/silhouette/node_bounds.h"

namespace limn {

SearchTree::SearchTree(std::span<const LeafCluster> clusters, std::span<const Plane> planes,
                       const QuantizedFrame& frame)
    : leaves_(clusters.size()), leaf_faces_(simd::kWidth * clusters.size()) {
  for (std::size_t l = 0; l < clusters.size(); ++l) {
    const LeafCluster& cluster = clusters[l];
    simd::Leaf& leaf = leaves_[l];
    leaf = {};
    for (std::size_t i = 0; i < cluster.edge_count; ++i) {
      leaf.edges[i] = cluster.edges[i];
      leaf.sides[i] = static_cast<std::uint8_t>(cluster.first[i] | cluster.second[i] << 4);
    }
    for (std::size_t i = 0; i < simd::kWidth; ++i)  // unused places repeat the last face
      leaf_faces_[simd::kWidth * l + i] = cluster.faces[std::min<std::size_t>(i, cluster.face_count - 1u)];
    edge_count_ += cluster.edge_count;
  }
  refit(planes, frame);
}

void SearchTree::refit(std::span<const Plane> planes, const QuantizedFrame& frame) {
  planes_ = planes;
  frame_ = frame;
  quantize_leaves(leaf_faces_, planes, frame, leaves_);
  levels_ = bound_nodes(leaves_);
}

std::span<const EdgeId> SearchTree::find(const Eye& eye, SearchScratch& scratch, SearchCounters* counters,
                                         SimdLevel level) const {
  return sweep_from(levels_.size() - 1, eye, scratch, counters, level);
}

std::span<const EdgeId> SearchTree::find_flat(const Eye& eye, SearchScratch& scratch, SearchCounters* counters,
                                              SimdLevel level) const {
  return sweep_from(0, eye, scratch, counters, level);
}

std::span<const EdgeId> SearchTree::sweep_from(std::size_t level, const Eye& eye, SearchScratch& scratch,
                                               SearchCounters* counters, SimdLevel simd) const {
  if (leaves_.empty()) return {};
  const ExactContext context{planes_, eye};
  const simd::EyeWords words = quantize(frame_, context);
  const simd::Kernels& kernels = simd::kernels(simd);
  std::size_t count = words.decisive ? levels_[level].size() : leaves_.size();
  const std::uint32_t* entered = nullptr;  // all
  for (std::size_t l = words.decisive ? level + 1 : 0; l-- > 0;) {
    if (scratch.next.size() < simd::kWidth * (count + 1)) scratch.next.resize(simd::kWidth * (count + 1));
    if (counters != nullptr) counters->groups_tested += count;
    count = kernels.sweep_groups(levels_[l].data(), entered, count, words, scratch.next.data());
    scratch.next.swap(scratch.current);
    entered = scratch.current.data();
  }
  if (counters != nullptr) counters->leaves_tested += count;
  if (scratch.edges.size() < simd::kWidth * (count + 1)) scratch.edges.resize(simd::kWidth * (count + 1));
  const std::size_t found =
      kernels.sweep_leaves(leaves_.data(), leaf_faces_.data(), entered, count, words, scratch.edges.data());
  return {scratch.edges.data(), found};
}

std::size_t SearchTree::memory_bytes() const {
  std::size_t bytes = leaves_.size() * sizeof(simd::Leaf) + leaf_faces_.size() * sizeof(FaceId);
  for (const auto& level : levels_)
    bytes += level.size() * sizeof(simd::NodeGroup);
  return bytes;
}

}  // namespace limn
