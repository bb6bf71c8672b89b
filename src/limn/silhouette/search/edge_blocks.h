#pragma once

#include <span>
#include <vector>

#include "limn/base/aligned.h"
#include "limn/silhouette/facing.h"
#include "limn/silhouette/search/edge_clusters.h"
#include "limn/silhouette/search/quantized.h"
#include "limn/silhouette/search/simd/level.h"

namespace limn {

/// Brute force at the speed of memory: every edge is tested, in blocks of up to 128 faces and 128 edges between them,
/// so that an edge finds its faces' bits in two shuffles instead of two loads from anywhere.
class EdgeBlocks {
 public:
  enum class Planes {
    kQuantized,  ///< 16 bits a number, doubt settled exactly: half the bytes (quantized.h)
    kExact,      ///< floats
  };

  EdgeBlocks() = default;

  /// \param clusters  from block_clusters() of the same mesh
  /// Keeps `planes`, not a copy: they must outlive it. Same bits for any number of threads.
  EdgeBlocks(std::span<const BlockCluster> clusters, std::span<const Plane> planes, const QuantizedFrame& frame,
             Planes storage = Planes::kQuantized);

  /// Every silhouette edge once: the set of extract_silhouette_brute(), in the blocks' order.
  /// \param edges  overwritten. Same order for any level and number of threads.
  /// Cost: 9 bytes (exact: 15) of memory traffic an edge, and what it finds; uses threads on large meshes.
  void extract(const Eye& eye, std::vector<EdgeId>& edges, SimdLevel level = best_simd_level()) const;

  std::size_t edge_count() const { return edge_count_; }
  /// Bytes that a query reads, whatever it finds.
  std::size_t swept_bytes() const;
  /// Bytes held in all.
  std::size_t memory_bytes() const;

 private:
  std::size_t sweep(std::size_t begin, std::size_t end, const simd::EyeWords& eye, SimdLevel level,
                    std::uint32_t* slots) const;
  void add_block(const BlockCluster& cluster);

  Planes storage_ = Planes::kQuantized;
  std::span<const Plane> planes_;
  QuantizedFrame frame_;
  std::size_t edge_count_ = 0;
  std::vector<simd::Block> blocks_;
  LineVector<simd::PlaneGroup> quantized_;
  LineVector<simd::ExactGroup> exact_;
  LineVector<simd::EdgeSides> sides_;
  std::vector<FaceId> faces_;  ///< 16 a plane group
  std::vector<EdgeId> ids_;    ///< 64 an EdgeSides
};

}  // namespace limn
