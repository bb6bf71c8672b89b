#pragma once

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "limn/bake/bake.h"
#include "limn/mesh/shapes.h"

namespace limn::test {

inline Mesh shape(Shape which, std::size_t faces) {
  Result<Mesh> mesh = make_shape(which, {.faces = faces});
  EXPECT_TRUE(mesh) << format_error(mesh.error());
  return mesh ? std::move(*mesh) : Mesh{};
}

/// A sphere of radius 1: a vertex's normal is its place.
inline Mesh sphere(std::size_t faces) {
  Mesh mesh = shape(Shape::kIcosphere, faces);
  mesh.uvs = {};
  return mesh;
}

/// An icosahedron (20 faces) around the sphere: its faces lie outside.
inline Mesh cage() {
  Mesh mesh = sphere(20);
  for (Vec3& p : mesh.positions)
    p *= 1.3f;
  return mesh;
}

inline Result<BakedMaps> baked(const Mesh& high, const Mesh& low, const BakeOptions& options) {
  Result<BakedMaps> maps = bake(high, low, options);
  EXPECT_TRUE(maps) << format_error(maps.error());
  return maps;
}

inline Vec3 vector_at(const FloatImage& image, std::size_t texel) {
  return {image.values[3 * texel], image.values[3 * texel + 1], image.values[3 * texel + 2]};
}

}  // namespace limn::test
