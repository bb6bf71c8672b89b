#pragma once

#include <cstdint>
#include <vector>

#include "limn/base/vec.h"
#include "limn/mesh/ids.h"

namespace limn {

/// Why an edge is drawn.
enum class LineClass : std::uint8_t {
  kSilhouette,   ///< one face seen from the front, the other from the back
  kBoundary,     ///< one face only
  kCrease,       ///< two faces that meet at an angle
  kNonManifold,  ///< three faces or more, or two that disagree on the front
};

/// Consecutive points that are drawn as one stroke.
struct Polyline {
  std::uint32_t begin = 0;  ///< first point in Polylines::points
  std::uint32_t end = 0;    ///< one past the last; at least two points
  LineClass line_class = LineClass::kSilhouette;
  bool closed = false;  ///< the last point is joined to the first, which is not repeated
  bool visible = true;  ///< false: hidden behind the mesh all along
  bool outer = false;   ///< part of the outer outline: past it, the background is seen
};

/// Polylines in the mesh's space, in one block of memory. Silhouettes run with the front face on their left.
struct Polylines {
  std::vector<Vec3> points;
  /// Beside each point the edge on which the segment that starts there lies; kInvalidId at the end of an open polyline,
  /// and for a segment along a line of sight, which is a point in the picture (outer_outline.h).
  std::vector<EdgeId> edges;
  std::vector<Polyline> lines;
};

}  // namespace limn
