#pragma once

#include <span>
#include <string>
#include <vector>

#include "limn/mesh/topology.h"
#include "limn/silhouette/visible/visible_lines.h"

namespace limn {

/// A stretch of an edge, as shares of the way from v[0] to v[1]; 0 <= from < to <= 1.
struct EdgePart {
  float from;
  float to;
};

/// An edge that is drawn, and what of it is seen.
struct DrawnEdge {
  EdgeId edge = kInvalidId;
  LineClass line_class = LineClass::kSilhouette;
  bool outer = false;             ///< some part of it is on the outer outline
  bool hidden = false;            ///< some part of it is hidden
  std::vector<EdgePart> visible;  ///< ascending, apart; {0, 1} alone when nothing is hidden
};

/// What the intervals say, edge by edge. \pre as in VisibleLines: ascending by (edge, begin), those of an edge cover it
std::vector<DrawnEdge> drawn_edges(std::span<const EdgeInterval> intervals);

/// A JSON array, one edge a line: {"v":[a,b],"class":"silhouette","visible":true}, a < b the vertices' indices in the
/// mesh's order, the lowest of each welded position. `visible` is whether any part of the edge is seen; where another
/// part is hidden, "visible_parts" lists the seen ones as [from,to], shares of the way from a to b. "outer":true marks
/// edges of the outer outline. Same edges, same bytes.
std::string edges_json(const std::vector<DrawnEdge>& edges, const Topology& topology);

}  // namespace limn
