#pragma once

#include <cmath>
#include <cstdint>

#include "limn/base/camera.h"
#include "limn/base/random.h"
#include "limn/compare/coverage.h"
#include "limn/mesh/mesh.h"

namespace limn::test {

/// An orthographic camera for which x and y of a vertex are pixels from the top left corner of the picture.
inline Camera pixel_camera(int width, int height) {
  Camera camera;
  camera.target = Vec3(0.5f * static_cast<float>(width), -0.5f * static_cast<float>(height), 0);
  camera.eye = camera.target + Vec3(0, 0, 10);
  camera.orthographic = true;
  camera.ortho_height = static_cast<float>(height);
  return camera;
}

/// A vertex for pixel_camera: x to the right and y downwards, in pixels.
inline Vec3 at_pixel(double x, double y) {
  return Vec3(static_cast<float>(x), static_cast<float>(-y), 0);
}

/// Pixels whose centre lies within `radius` of (x, y).
inline Coverage disc(int size, double x, double y, double radius) {
  Coverage coverage(size, size);
  for (int py = 0; py < size; ++py) {
    for (int px = 0; px < size; ++px) {
      if (std::hypot(px + 0.5 - x, py + 0.5 - y) <= radius) coverage.at(px, py) = 1;
    }
  }
  return coverage;
}

/// Appends a triangle with vertices of its own.
inline void add_triangle(Mesh& mesh, const Vec3& a, const Vec3& b, const Vec3& c) {
  const VertexId first = static_cast<VertexId>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), {a, b, c});
  mesh.faces.push_back({first, first + 1, first + 2});
}

}  // namespace limn::test
