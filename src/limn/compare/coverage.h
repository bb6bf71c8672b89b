#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "limn/base/camera.h"
#include "limn/mesh/mesh.h"

namespace limn {

/// Which pixels a picture covers: 1 or 0 each, rows from the top.
struct Coverage {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> covered;

  Coverage() = default;
  Coverage(int w, int h) : width(w), height(h), covered(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
  std::uint8_t& at(int x, int y) { return covered[static_cast<std::size_t>(y) * width + x]; }
  std::uint8_t at(int x, int y) const { return covered[static_cast<std::size_t>(y) * width + x]; }
};

/// The largest width and height of a Coverage.
inline constexpr int kMaxCoverageSize = 16384;

/// Rasterizes a mesh's coverage on the CPU: a pixel counts when its centre lies in a projected triangle, front or back,
/// by the top-left rule on a 1/256-pixel grid with integer edge functions.
///
/// Vertices are projected in double, in one fixed order of operations, and then snapped to the grid, so the picture is
/// the same on every machine and for any number of threads. No pixel is lost between two triangles that share an edge.
/// Perspective: triangles that reach behind the near plane are clipped there. Nothing is clipped at the far plane, nor
/// at either plane of an orthographic camera. Triangles without area on the grid, or with a coordinate that is not
/// finite, cover nothing. Coordinates of any size are safe (docs/outline-error.md). \pre every index is in range; 1 <=
/// width, height <= kMaxCoverageSize; camera.eye != camera.target Cost: linear in vertices, faces and pixels, spread
/// over the threads; one bit a pixel and thread, 8 bytes a vertex.
Coverage rasterize_coverage(const Mesh& mesh, const Camera& camera, int width, int height);

}  // namespace limn
