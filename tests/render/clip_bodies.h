#pragma once

#include <glm/geometric.hpp>

#include "limn/asset/clip_asset.h"
#include "limn/mesh/shapes.h"

#include "drawing_test.h"

namespace limn::test {

inline Mesh shape(Shape kind, std::size_t faces) {
  auto made = make_shape(kind, {.faces = faces});
  EXPECT_TRUE(made);
  return made ? std::move(*made) : Mesh{};
}

/// A sphere around all of a mesh: the crudest hull.
inline Mesh sphere_around(const Mesh& mesh, float margin = 1.0f) {
  const Bounds bounds = face_bounds(mesh);
  const Vec3 middle = bounds.center();
  float radius = 0;
  for (const Vec3& p : mesh.positions)
    radius = std::max(radius, glm::length(p - middle));
  Mesh hull = shape(Shape::kIcosphere, 320);
  for (Vec3& p : hull.positions)
    p = middle + 1.08f * margin * radius * p;
  return hull;
}

/// The original alone, within a sphere.
inline ClipAsset asset_of(const Mesh& original, const Mesh& hull) {
  ClipAsset asset;
  asset.hull = hull;
  Mesh mesh;
  mesh.positions = original.positions;
  mesh.faces = original.faces;
  asset.levels.push_back({mesh, 0.0f, {}});
  asset.bounds = face_bounds(original);
  return asset;
}

inline ClipAsset asset_of(const Mesh& original) {
  return asset_of(original, sphere_around(original));
}

/// Pixels of which one picture covers some, the other none.
inline std::size_t count_differing(const Image& a, const Image& b) {
  std::size_t count = 0;
  for (std::size_t i = 3; i < a.rgba.size(); i += 4)
    count += (a.rgba[i] > 0) != (b.rgba[i] > 0) ? 1 : 0;
  return count;
}

}  // namespace limn::test
