#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "limn/mesh/topology.h"

namespace limn::asset {

/// The leaf of each edge (leaf_partition.h) in few bytes: about a fifth of a byte an edge, since an edge mostly lies in
/// the leaf of one that it shares a face with. Same partition, same bytes. Cost: about 0.1 µs an edge.
/// \pre a partition of this topology
std::vector<std::byte> encode_leaves(std::span<const std::uint32_t> leaf_of_edge, const Topology& topology);

/// The partition that was encoded; nothing when the bytes are not those of one of this topology, as
/// partition_clusters() would find. Time and memory stay within those of the topology.
std::optional<std::vector<std::uint32_t>> decode_leaves(std::span<const std::byte> bytes, const Topology& topology);

}  // namespace limn::asset
