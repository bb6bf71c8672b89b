#pragma once

#include <cstdint>
#include <vector>

#include "limn/drawing/layer.h"
#include "limn/drawing/nodes.h"

namespace limn::drawing {

/// A straight piece of a stroke. Pieces follow one another in the order of the lines they come from.
struct Piece {
  NodeId a;
  NodeId b;
  std::uint32_t line;  ///< pieces of one line have the same number
  Layer layer;
};

/// Takes out what lies on another piece: of pieces that run along one another within the tolerance, that of the lower
/// layer stays, then the earlier one. A piece that is partly covered comes back as what is left of it, in order. Pieces
/// that merely cross or touch are left alone.
///
/// \param nodes  gains points where pieces are cut
/// Cost: O(n log n) while pieces are spread over the page; the square of the number crowded into one square whose side
/// is the mean length. Same result for any number of threads. \pre a != b for every piece
std::vector<Piece> without_overlaps(const std::vector<Piece>& pieces, Nodes& nodes, double tolerance_steps);

}  // namespace limn::drawing
