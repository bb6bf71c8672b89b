#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "limn/mesh/topology.h"
#include "limn/silhouette/search/edge_blocks.h"
#include "limn/silhouette/search/search_tree.h"

namespace limn {

/// How silhouettes are searched. All give the same set.
enum class SearchMethod {
  kAuto,   ///< the tree, or brute force for meshes or from eyes for which the tree leaves too little out
  kBrute,  ///< every edge, in blocks (edge_blocks.h)
  kFlat,   ///< every node above the leaves, then the leaves that need it
  kTree,   ///< down the tree (search_tree.h)
};

/// Finds the silhouettes of one mesh from many eyes, the fastest way: what to use unless you want to choose.
class SilhouetteExtractor {
 public:
  /// Keeps `planes`, not a copy: they must outlive it. Same bits for any number of threads.
  /// \param leaves  what leaf_clusters() gave for this mesh, where they are at hand (leaf_partition.h); else made here
  /// \pre planes from face_planes(mesh), topology from build_topology(mesh)
  /// Cost: about 0.5 µs an edge on one core and 40 bytes an edge; kBrute a third of the time and half the memory.
  SilhouetteExtractor(const Mesh& mesh, const Topology& topology, std::span<const Plane> planes,
                      SearchMethod method = SearchMethod::kAuto, std::span<const LeafCluster> leaves = {});

  /// Every silhouette edge once: the set of extract_silhouette_brute(), in an order that depends on the mesh and the
  /// way taken alone, not on threads or instruction sets. \return the edges, within the scratch: valid until it is used
  /// again
  std::span<const EdgeId> find(const Eye& eye, SearchScratch& scratch, SimdLevel level = best_simd_level()) const;

  /// The same in ascending order. Allocates.
  std::vector<EdgeId> find_sorted(const Eye& eye) const;

  const SearchTree& tree() const { return tree_; }
  const EdgeBlocks& blocks() const { return blocks_; }
  std::size_t memory_bytes() const { return tree_.memory_bytes() + blocks_.memory_bytes(); }

 private:
  SearchMethod method_;
  SearchTree tree_;
  EdgeBlocks blocks_;
};

}  // namespace limn
