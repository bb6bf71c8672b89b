#pragma once

#include <vector>

#include "limn/drawing/overlap.h"

namespace limn::drawing {

/// Nodes drawn without lifting the pen.
struct Chain {
  std::vector<NodeId> nodes;
  Layer layer;
  bool closed = false;  ///< the first node is not repeated
};

/// Joins pieces end to end: consecutive pieces of one line where they meet, and then the two ends of a layer that are
/// left at a node. Every piece is in one chain, once. By layer, then in the order of the pieces. O(n log n).
std::vector<Chain> join(const std::vector<Piece>& pieces);

/// Leaves out nodes of a chain that lie within the tolerance of the line between the nodes that stay; its ends stay.
/// An open chain of one place, or a closed one no wider than the tolerance, loses its middle too. O(n).
void straighten(Chain& chain, const Nodes& nodes, double tolerance_steps);

}  // namespace limn::drawing
