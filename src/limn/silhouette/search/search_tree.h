#pragma once

#include <optional>
#include <span>
#include <vector>

#include "limn/base/aligned.h"
#include "limn/silhouette/facing.h"
#include "limn/silhouette/search/edge_clusters.h"
#include "limn/silhouette/search/quantized.h"
#include "limn/silhouette/search/simd/level.h"

namespace limn {

/// What a query did.
struct SearchCounters {
  std::size_t groups_tested = 0;  ///< groups of 16 nodes
  std::size_t leaves_tested = 0;  ///< leaves of up to 16 edges
};

/// Memory that queries use, kept from one to the next. One a thread.
struct SearchScratch {
  LineVector<std::uint32_t> current, next, edges;
  std::vector<EdgeId> all;          ///< what brute force found
  std::vector<std::size_t> counts;  ///< edges found by each task
};

/// A tree of edge clusters, 16 children to a node, that finds the silhouette by leaving out whatever surely faces one
/// way. Sander et al. 2000, section 5, as one would build it today (docs/search-tree.md).
///
/// A node bounds its faces' planes by a ball of normals about a quantized one, and an interval of offsets at an anchor
/// point: n·p + d is a·(p - c) + e give or take r |p - c| + h. Sixteen nodes are tested by six multiply-adds of 16-bit
/// pairs. Everything the tree decides is decided in integers, alike on every machine; bounds hold the roundings of the
/// float test, so the edges found are exactly those of extract_silhouette_brute().
class SearchTree {
 public:
  SearchTree() = default;

  /// \param clusters  from leaf_clusters() of the same mesh
  /// Keeps `planes`, not a copy: they must outlive it. Same bits for any number of threads.
  /// Cost: about 0.2 µs an edge on one core, beside that of the clusters; 25 bytes an edge.
  SearchTree(std::span<const LeafCluster> clusters, std::span<const Plane> planes, const QuantizedFrame& frame);

  /// Follows a mesh whose vertices have moved but whose faces have not: new bounds over the same clusters. What is
  /// found stays exact however far they moved; the tree serves best while neighbours go on facing nearly the same way.
  void refit(std::span<const Plane> planes, const QuantizedFrame& frame);

  /// Every silhouette edge once: the set of extract_silhouette_brute(), in the order of the leaves.
  /// \return the edges, within the scratch: valid until it is used again. Same order for any level.
  /// Cost: grows with the silhouette; see docs/search-tree.md. Uses threads where thousands of leaves are entered.
  std::span<const EdgeId> find(const Eye& eye, SearchScratch& scratch, SearchCounters* counters = nullptr,
                               SimdLevel level = best_simd_level()) const;

  /// As find(), but tests the nodes above the leaves all in turn: less work where most would be entered.
  std::span<const EdgeId> find_flat(const Eye& eye, SearchScratch& scratch, SearchCounters* counters = nullptr,
                                    SimdLevel level = best_simd_level()) const;

  /// As find(), unless more than `most_leaves` leaves are entered: then nothing, and brute force is the faster way.
  std::optional<std::span<const EdgeId>> find_if_sparse(const Eye& eye, std::size_t most_leaves, SearchScratch& scratch,
                                                        SimdLevel level = best_simd_level()) const;

  /// Counts what find() would visit, without reading the leaves.
  void count_leaves(const Eye& eye, SearchScratch& scratch, SearchCounters& counters) const;

  std::size_t leaf_count() const { return leaves_.size(); }
  std::size_t edge_count() const { return edge_count_; }
  std::size_t memory_bytes() const;

 private:
  friend class MovingSilhouette;
  friend class SearchTreeFile;

  /// Leaves that may hold silhouettes, in scratch.current; null for all. \param top the level to begin at
  struct Entered {
    const std::uint32_t* leaves;
    std::size_t count;
  };
  Entered enter(std::size_t top, const simd::EyeWords& eye, SearchScratch& scratch, SearchCounters* counters,
                SimdLevel level) const;
  std::span<const EdgeId> read(const Entered& entered, const simd::EyeWords& eye, SearchScratch& scratch,
                               SimdLevel level) const;

  std::span<const Plane> planes_;
  QuantizedFrame frame_;
  std::size_t edge_count_ = 0;
  LineVector<simd::Leaf> leaves_;
  std::vector<FaceId> leaf_faces_;                   ///< 16 a leaf
  std::vector<LineVector<simd::NodeGroup>> levels_;  ///< levels_[0] bounds the leaves, levels_[i] levels_[i-1]
};

}  // namespace limn
