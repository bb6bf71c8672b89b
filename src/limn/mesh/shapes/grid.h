#pragma once

#include <cstddef>
#include <functional>

#include "limn/mesh/mesh.h"

namespace limn::procedural {

/// Quads along the two directions of a rectangular grid; each is two faces.
struct GridSize {
  std::size_t u = 1, v = 1;
};

/// The grid of nearest to `faces` faces whose sides are about as ratio : 1. \pre minimum.u and .v >= 1, ratio > 0
GridSize choose_grid(std::size_t faces, double ratio, const GridSize& minimum);

/// A point of a surface, with its unit normal.
struct SurfacePoint {
  DVec3 position, normal;
};

/// What a grid's points are: called with i in [0, u], j in [0, v] (up to u-1 and v-1 when closed), from several
/// threads. The partial derivatives along i and j and the normal form a right-handed frame.
using GridSurface = std::function<SurfacePoint(std::size_t i, std::size_t j)>;

/// A grid with a boundary: uvs run from (0,0) to (1,1), one a vertex.
Mesh open_grid(const GridSize& size, const GridSurface& surface);

/// A grid closed both ways: positions once, uvs split along both seams.
Mesh closed_grid(const GridSize& size, const GridSurface& surface);

}  // namespace limn::procedural
