#include "limn/silhouette/search/search_tree.h"

#include <algorithm>

#include "limn/base/parallel.h"
#include "limn/silhouette/search/node_bounds.h"

namespace limn {
namespace {

constexpr std::size_t kLeavesPerTask = 2048;
/// Fewer tasks than these are done before another thread has woken up.
constexpr std::size_t kTasksWorthThreads = 4;

}  // namespace

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

void SearchTree::count_leaves(const Eye& eye, SearchScratch& scratch, SearchCounters& counters) const {
  if (leaves_.empty()) return;
  const ExactContext context{planes_, eye};
  enter(levels_.size() - 1, quantize(frame_, context), scratch, &counters, best_simd_level());
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
  // Each task writes into a room of its own, with what the kernels need beyond the last number.
  constexpr std::size_t kRoom = simd::kWidth * (kLeavesPerTask + 1);
  const simd::Kernels& kernels = simd::kernels(level);
  const std::size_t tasks = (entered.count + kLeavesPerTask - 1) / kLeavesPerTask;
  if (scratch.edges.size() < tasks * kRoom) scratch.edges.resize(tasks * kRoom);
  scratch.counts.resize(tasks);
  const auto sweep = [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const std::size_t first = t * kLeavesPerTask;
      const std::size_t count = std::min(kLeavesPerTask, entered.count - first);
      // Without a list the leaves themselves begin further on.
      const simd::Leaf* leaves = leaves_.data() + (entered.leaves != nullptr ? 0 : first);
      const FaceId* faces = leaf_faces_.data() + (entered.leaves != nullptr ? 0 : simd::kWidth * first);
      const std::uint32_t* list = entered.leaves != nullptr ? entered.leaves + first : nullptr;
      scratch.counts[t] = kernels.sweep_leaves(leaves, faces, list, count, eye, scratch.edges.data() + t * kRoom);
    }
  };
  if (tasks < kTasksWorthThreads)
    sweep(0, tasks);
  else
    parallel_for(tasks, 1, sweep);
  std::size_t found = 0;
  for (std::size_t t = 0; t < tasks; ++t) {
    const std::uint32_t* from = scratch.edges.data() + t * kRoom;
    if (t != 0) std::copy_n(from, scratch.counts[t], scratch.edges.data() + found);
    found += scratch.counts[t];
  }
  return {scratch.edges.data(), found};
}

std::size_t SearchTree::memory_bytes() const {
  std::size_t bytes = leaves_.size() * sizeof(simd::Leaf) + leaf_faces_.size() * sizeof(FaceId);
  for (const auto& level : levels_)
    bytes += level.size() * sizeof(simd::NodeGroup);
  return bytes;
}

}  // namespace limn
