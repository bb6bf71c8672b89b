#include "limn/silhouette/search_tree.h"

#include <algorithm>

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
  if (leaves_.empty()) return {};
  const ExactContext context{planes_, eye};
  const simd::EyeWords words = quantize(frame_, context);
  return read(enter(levels_.size() - 1, words, scratch, counters, level), words, scratch, level);
}

std::span<const EdgeId> SearchTree::find_flat(const Eye& eye, SearchScratch& scratch, SearchCounters* counters,
                                              SimdLevel level) const {
  if (leaves_.empty()) return {};
  const ExactContext context{planes_, eye};
  const simd::EyeWords words = quantize(frame_, context);
  return read(enter(0, words, scratch, counters, level), words, scratch, level);
}

std::optional<std::span<const EdgeId>> SearchTree::find_if_sparse(const Eye& eye, std::size_t most_leaves,
                                                                  SearchScratch& scratch, SimdLevel level) const {
  if (leaves_.empty()) return std::span<const EdgeId>{};
  const ExactContext context{planes_, eye};
  const simd::EyeWords words = quantize(frame_, context);
  const Entered entered = enter(levels_.size() - 1, words, scratch, nullptr, level);
  if (entered.count > most_leaves) return std::nullopt;
  return read(entered, words, scratch, level);
}

SearchTree::Entered SearchTree::enter(std::size_t top, const simd::EyeWords& eye, SearchScratch& scratch,
                                      SearchCounters* counters, SimdLevel level) const {
  Entered entered{nullptr, leaves_.size()};
  if (eye.decisive) {
    entered.count = levels_[top].size();
    for (std::size_t l = top + 1; l-- > 0;) {
      const std::size_t room = simd::kWidth * (entered.count + 1);
      if (scratch.next.size() < room) scratch.next.resize(room);
      if (counters != nullptr) counters->groups_tested += entered.count;
      entered.count =
          simd::kernels(level).sweep_groups(levels_[l].data(), entered.leaves, entered.count, eye, scratch.next.data());
      scratch.next.swap(scratch.current);
      entered.leaves = scratch.current.data();
    }
  }
  if (counters != nullptr) counters->leaves_tested += entered.count;
  return entered;
}

std::span<const EdgeId> SearchTree::read(const Entered& entered, const simd::EyeWords& eye, SearchScratch& scratch,
                                         SimdLevel level) const {
  const std::size_t room = simd::kWidth * (entered.count + 1);
  if (scratch.edges.size() < room) scratch.edges.resize(room);
  const std::size_t found = simd::kernels(level).sweep_leaves(leaves_.data(), leaf_faces_.data(), entered.leaves,
                                                              entered.count, eye, scratch.edges.data());
  return {scratch.edges.data(), found};
}

std::size_t SearchTree::memory_bytes() const {
  std::size_t bytes = leaves_.size() * sizeof(simd::Leaf) + leaf_faces_.size() * sizeof(FaceId);
  for (const auto& level : levels_)
    bytes += level.size() * sizeof(simd::NodeGroup);
  return bytes;
}

}  // namespace limn
