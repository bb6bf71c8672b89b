#pragma once

#include <string>

#include "limn/silhouette/lines.h"

namespace limn {

/// Polylines as a Wavefront OBJ of `v` and `l` elements, one `l` a polyline, in groups named after class and visibility
/// ("g silhouette-visible", layer_name). A closed polyline ends with its first vertex.
///
/// Coordinates keep their bits (the shortest digits that read back the same); points of equal coordinates are one
/// vertex, so that lines that meet do so in the file. Same lines, same bytes. Cost: one pass and a sort.
std::string obj_text(const Polylines& lines);

/// The same as PLY: vertices, and an `edge` element with `vertex1`, `vertex2`, `class` (LineClass as a number: 0
/// silhouette, 1 boundary, 2 crease, 3 non-manifold), `visible` and `outer` (0 or 1), and `line`, the number of its
/// polyline. Binary little-endian, or text. Segments whose ends are equal are left out.
std::string ply_text(const Polylines& lines, bool ascii);

}  // namespace limn
