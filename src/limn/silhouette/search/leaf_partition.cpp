#include "limn/silhouette/search/leaf_partition.h"

namespace limn {
namespace {

bool is_searched(EdgeClass edge_class) {
  return edge_class == EdgeClass::kManifold || edge_class == EdgeClass::kInconsistent;
}

/// The face's number within the cluster, where it is put if need be; kFaces when it has no more room.
std::size_t number_of(LeafCluster& cluster, FaceId face) {
  std::size_t i = 0;
  while (i < cluster.face_count && cluster.faces[i] != face)
    ++i;
  if (i < cluster.face_count || i == LeafCluster::kFaces) return i;
  cluster.faces[i] = face;
  ++cluster.face_count;
  return i;
}

bool put(LeafCluster& cluster, EdgeId edge, const Edge& ends) {
  if (cluster.edge_count == LeafCluster::kEdges) return false;
  const std::size_t first = number_of(cluster, ends.face[0]);
  const std::size_t second = number_of(cluster, ends.face[1]);
  if (first == LeafCluster::kFaces || second == LeafCluster::kFaces) return false;
  cluster.edges[cluster.edge_count] = edge;
  cluster.first[cluster.edge_count] = static_cast<std::uint8_t>(first);
  cluster.second[cluster.edge_count] = static_cast<std::uint8_t>(second);
  ++cluster.edge_count;
  return true;
}

}  // namespace

std::vector<std::uint32_t> leaf_partition(std::span<const LeafCluster> clusters, const Topology& topology) {
  std::vector<std::uint32_t> leaf_of_edge(topology.edge_count(), kInvalidId);
  for (std::size_t l = 0; l < clusters.size(); ++l) {
    for (std::size_t i = 0; i < clusters[l].edge_count; ++i)
      leaf_of_edge[clusters[l].edges[i]] = static_cast<std::uint32_t>(l);
  }
  return leaf_of_edge;
}

std::optional<std::vector<LeafCluster>> partition_clusters(std::span<const std::uint32_t> leaf_of_edge,
                                                           const Topology& topology) {
  if (leaf_of_edge.size() != topology.edge_count()) return std::nullopt;
  std::size_t leaves = 0;
  for (const std::uint32_t leaf : leaf_of_edge) {
    if (leaf == kInvalidId) continue;
    if (leaf >= topology.edge_count()) return std::nullopt;
    if (leaf >= leaves) leaves = std::size_t{leaf} + 1;
  }
  std::vector<LeafCluster> clusters(leaves, LeafCluster{});
  for (EdgeId e = 0; e < topology.edge_count(); ++e) {
    if (is_searched(topology.edge_class[e]) != (leaf_of_edge[e] != kInvalidId)) return std::nullopt;
    if (leaf_of_edge[e] != kInvalidId && !put(clusters[leaf_of_edge[e]], e, topology.edges[e])) return std::nullopt;
  }
  for (const LeafCluster& cluster : clusters) {
    if (cluster.edge_count == 0) return std::nullopt;
  }
  return clusters;
}

}  // namespace limn
