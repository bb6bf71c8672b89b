#pragma once

#include <span>
#include <vector>

#include "limn/base/aligned.h"
#include "limn/silhouette/facing.h"
#include "limn/silhouette/search/quantized.h"

namespace limn {

/// Fills the leaves' planes. \param leaf_faces 16 a leaf
void quantize_leaves(std::span<const FaceId> leaf_faces, std::span<const Plane> planes, const QuantizedFrame& frame,
                     LineVector<simd::Leaf>& leaves);

/// The nodes over the leaves, level by level: level 0 has a node for each leaf, in groups of 16; level i + 1 a node for
/// each group of level i; the last level is one group. Unused nodes of a last group are never entered.
///
/// Every node's bound holds for the leaves' quantized planes and the planes they stand for. Same result for any number
/// of threads. Cost: a few passes over the leaves.
std::vector<LineVector<simd::NodeGroup>> bound_nodes(std::span<const simd::Leaf> leaves);

}  // namespace limn
