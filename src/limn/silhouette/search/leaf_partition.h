#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "limn/silhouette/search/edge_clusters.h"

namespace limn {

/// A search tree as plain data: for each edge the leaf it lies in, kInvalidId for edges that are not searched
/// (boundary, non-manifold). All else of a tree follows from it and the mesh.
/// \pre each edge in one cluster at most
std::vector<std::uint32_t> leaf_partition(std::span<const LeafCluster> clusters, const Topology& topology);

/// The clusters of a partition, each with its edges in ascending order: what SearchTree and SilhouetteExtractor take.
/// Nothing when the partition is none of this mesh: an edge with two faces without a leaf or another one with one, a
/// leaf of more than 16 edges or 16 faces, or a leaf without edges. So whatever it came from, a tree built on what this
/// returns finds exactly the silhouettes. Cost: a pass over the edges.
std::optional<std::vector<LeafCluster>> partition_clusters(std::span<const std::uint32_t> leaf_of_edge,
                                                           const Topology& topology);

}  // namespace limn
