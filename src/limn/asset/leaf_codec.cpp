#include "limn/asset/leaf_codec.h"

#include <algorithm>
#include <array>

#include "limn/asset/range_coder.h"
#include "limn/silhouette/search/leaf_partition.h"

namespace limn::asset {
namespace {

bool is_searched(EdgeClass edge_class) {
  return edge_class == EdgeClass::kManifold || edge_class == EdgeClass::kInconsistent;
}

/// Edges in the order in which faces name them; each lies in the leaf of an edge beside it, or in one that is named.
template <class Coder>
class LeafCodec {
 public:
  LeafCodec(Coder& coder, const Topology& topology)
      : coder_(coder), topology_(topology), edges_in_(topology.edge_count(), 0) {}

  /// From or into `leaves`; false when a decoder's stream makes no sense.
  bool code(std::vector<std::uint32_t>& leaves) {
    std::vector<bool> coded(topology_.edge_count(), false);
    for (const std::array<EdgeId, 3>& edges : topology_.face_edges) {
      for (const EdgeId edge : edges) {
        if (edge == kInvalidId || coded[edge] || !is_searched(topology_.edge_class[edge])) continue;
        find_candidates(edge, leaves, coded);
        if (coder_.failed() || !code_edge(leaves[edge])) return false;
        coded[edge] = true;
        ++edges_in_[leaves[edge]];
      }
    }
    return true;
  }

 private:
  static constexpr std::uint32_t kMostEdges = LeafCluster::kEdges;

  void find_candidates(EdgeId edge, const std::vector<std::uint32_t>& leaves, const std::vector<bool>& coded) {
    count_ = 0;
    for (const FaceId face : topology_.edges[edge].face) {
      for (const EdgeId other : topology_.face_edges[face]) {
        if (other == kInvalidId || !coded[other] || edges_in_[leaves[other]] >= kMostEdges) continue;
        const auto end = candidates_.begin() + count_;
        const auto same = std::find(candidates_.begin(), end, leaves[other]);
        if (same != end) {
          ++votes_[static_cast<std::size_t>(same - candidates_.begin())];
        } else {
          candidates_[static_cast<std::size_t>(count_)] = leaves[other];
          votes_[static_cast<std::size_t>(count_++)] = 1;
        }
      }
    }
  }

  bool code_edge(std::uint32_t& leaf) {
    for (int i = 0; i < count_; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const std::uint32_t votes = std::min<std::uint32_t>(votes_[k], 2) - 1;
      Probability& probability = is_candidate_[k][static_cast<std::size_t>(count_)][votes][edges_in_[candidates_[k]]];
      if (!coder_.bit(probability, leaf == candidates_[k])) continue;
      leaf = candidates_[k];
      return true;
    }
    const std::int64_t step = std::int64_t{leaf} - last_named_;
    const std::int64_t named = last_named_ + unzigzag(names_.code(coder_, zigzag(step)) & 0x3ffffffffu);
    if (named < 0 || named >= static_cast<std::int64_t>(edges_in_.size())) return false;
    leaf = static_cast<std::uint32_t>(named);
    last_named_ = named;
    return edges_in_[leaf] < kMostEdges;
  }

  Coder& coder_;
  const Topology& topology_;
  std::vector<std::uint8_t> edges_in_;
  std::array<std::uint32_t, 4> candidates_{};
  std::array<std::uint8_t, 4> votes_{};
  int count_ = 0;
  /// By place among the candidates, their number, whether several edges speak for it, and how full it is.
  std::array<std::array<std::array<std::array<Probability, kMostEdges>, 2>, 5>, 4> is_candidate_;
  NumberModel names_;
  std::int64_t last_named_ = 0;
};

}  // namespace

std::vector<std::byte> encode_leaves(std::span<const std::uint32_t> leaf_of_edge, const Topology& topology) {
  RangeEncoder coder;
  std::vector<std::uint32_t> leaves(leaf_of_edge.begin(), leaf_of_edge.end());
  LeafCodec<RangeEncoder>(coder, topology).code(leaves);
  return coder.finish();
}

std::optional<std::vector<std::uint32_t>> decode_leaves(std::span<const std::byte> bytes, const Topology& topology) {
  RangeDecoder coder(bytes);
  std::vector<std::uint32_t> leaves(topology.edge_count(), kInvalidId);
  if (!LeafCodec<RangeDecoder>(coder, topology).code(leaves) || coder.failed()) return std::nullopt;
  if (!partition_clusters(leaves, topology)) return std::nullopt;
  return leaves;
}

}  // namespace limn::asset
