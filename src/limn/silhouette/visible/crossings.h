#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "limn/base/vec.h"
#include "limn/mesh/ids.h"
#include "limn/silhouette/eye.h"

namespace limn {

/// A straight piece in space, as crossings are looked for.
struct Segment {
  DVec3 a, b;
  VertexId ends[2];  ///< segments that share a vertex meet there and are not compared
  bool line = true;  ///< it wants to know what crosses it
  bool edge = true;  ///< the number of layers may change across it: a fold, boundary or non-manifold edge
};

/// Where one segment is crossed by another in the picture.
struct Crossing {
  std::uint32_t segment = 0;
  double t = 0;          ///< 0 at a, 1 at b; along the segment in space, not in the picture
  bool in_front = true;  ///< the other lies nearer to the eye, or both are equally near
};

/// Finds where lines are crossed by edges in the picture: every pair, all around the eye, before and behind it alike.
///
/// Nothing is projected to a plane but what bounds the search: whether two segments cross, and where, comes from
/// determinants of the directions from the eye, so that none is lost at the rim of a picture or beside the eye.
/// Ties count: ends that touch within 1e-9 of a segment's length, and for segments that overlap along a line both ends
/// of the overlap. So a crossing may be reported that is none, but hardly one missed.
///
/// \param behind  whether crossings with in_front == false are wanted too
/// Ascending by (segment, t); equal ones once. Same bits for any number of threads.
/// Cost: near linear in segments + crossings: a uniform grid over the picture whose crowded cells are cut in four; many
/// long segments through one point cost their square.
std::vector<Crossing> find_crossings(std::span<const Segment> segments, const Eye& eye, bool behind);

}  // namespace limn
