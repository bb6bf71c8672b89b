#include "limn/silhouette/extractor.h"

#include <algorithm>

namespace limn {
namespace {

/// Above this share of leaves entered brute force is faster: it reads each edge in a third of the bytes that a leaf
/// takes. By then the nodes have cost a tenth of brute force (docs/search-tree.md).
constexpr double kSparse = 0.6;
/// Below this many leaves (about 1,500 faces) all is done before the nodes have paid.
constexpr std::size_t kFewLeaves = 150;

/// Whether most leaves would be entered from nearly everywhere: asked of a few eyes around the mesh.
bool is_dense(const SearchTree& tree, const QuantizedFrame& frame) {
  constexpr double kDistances[] = {1.5, 4.0};  // in radii of the mesh
  constexpr double kDense = 0.8;
  SearchScratch scratch;
  SearchCounters counters;
  std::size_t views = 0;
  for (const double distance : kDistances) {
    for (int axis = 0; axis < 6; ++axis) {
      DVec3 at = frame.origin + DVec3(0.31, 0.17, -0.23) * frame.scale;
      at[axis / 2] += (axis % 2 == 0 ? 1.0 : -1.0) * distance * frame.scale;
      tree.count_leaves({Vec3(at)}, scratch, counters);
      ++views;
    }
  }
  return static_cast<double>(counters.leaves_tested) > kDense * static_cast<double>(views * tree.leaf_count());
}

}  // namespace

SilhouetteExtractor::SilhouetteExtractor(const Mesh& mesh, const Topology& topology, std::span<const Plane> planes,
                                         SearchMethod method, std::span<const LeafCluster> leaves)
    : method_(method) {
  const QuantizedFrame frame = quantized_frame(mesh, planes);
  if (method != SearchMethod::kBrute && !leaves.empty()) tree_ = SearchTree(leaves, planes, frame);
  if (method != SearchMethod::kBrute && leaves.empty())
    tree_ = SearchTree(leaf_clusters(mesh, topology, planes), planes, frame);
  if (method == SearchMethod::kBrute || method == SearchMethod::kAuto)
    blocks_ = EdgeBlocks(block_clusters(mesh, topology), planes, frame);
  if (method == SearchMethod::kAuto && (tree_.leaf_count() < kFewLeaves || is_dense(tree_, frame))) tree_ = {};
}

std::span<const EdgeId> SilhouetteExtractor::find(const Eye& eye, SearchScratch& scratch, SimdLevel level) const {
  switch (method_) {
    case SearchMethod::kTree:
      return tree_.find(eye, scratch, nullptr, level);
    case SearchMethod::kFlat:
      return tree_.find_flat(eye, scratch, nullptr, level);
    case SearchMethod::kAuto: {
      if (tree_.leaf_count() == 0) break;  // it was not worth keeping
      const auto most = static_cast<std::size_t>(kSparse * static_cast<double>(tree_.leaf_count()));
      if (const auto found = tree_.find_if_sparse(eye, most, scratch, level)) return *found;
      break;
    }
    case SearchMethod::kBrute:
      break;
  }
  blocks_.extract(eye, scratch.all, level);
  return scratch.all;
}

std::vector<EdgeId> SilhouetteExtractor::find_sorted(const Eye& eye) const {
  SearchScratch scratch;
  const std::span<const EdgeId> found = find(eye, scratch);
  std::vector<EdgeId> edges(found.begin(), found.end());
  std::sort(edges.begin(), edges.end());
  return edges;
}

}  // namespace limn
