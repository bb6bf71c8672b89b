#pragma once

#include <cmath>
#include <glm/geometric.hpp>

#include "limn/asset/asset_file.h"
#include "limn/asset/mesh_codec.h"
#include "limn/mesh/shapes.h"
#include "limn/silhouette/facing.h"
#include "limn/silhouette/search/leaf_partition.h"

namespace limn::test {

/// A sphere with bumps.
inline Mesh bumpy_sphere(std::size_t faces) {
  Mesh mesh = *make_shape(Shape::kIcosphere, {.faces = faces});
  for (Vec3& p : mesh.positions)
    p *= 1.0f + 0.1f * std::sin(9.0f * p.x) * std::sin(7.0f * p.y + 2.0f * p.z);
  mesh.normals = {};
  mesh.uvs = {};
  return mesh;
}

/// A level of a mesh, with its search tree.
inline SilhouetteLevel level_of(const Mesh& mesh, float error) {
  SilhouetteLevel level{asset::order_for_storage(mesh), error, {}};
  const Topology topology = build_topology(level.mesh);
  level.leaf_of_edge = leaf_partition(leaf_clusters(level.mesh, topology, face_planes(level.mesh)), topology);
  return level;
}

/// Pixels that no predictor foresees, of every alpha.
inline Image noisy_image(int width, int height, std::uint64_t seed) {
  Image image(width, height);
  for (std::uint8_t& value : image.rgba) {
    seed = seed * 6364136223846793005ull + 1442695040888963407ull;
    value = static_cast<std::uint8_t>(seed >> 56);
  }
  return image;
}

/// What building an asset would give, made by hand: a bumpy sphere within a larger sphere of few faces, two levels, all
/// maps.
inline ClipAsset stand_in_asset(std::size_t faces = 1280) {
  ClipAsset asset;
  asset.hull = *make_shape(Shape::kIcosphere, {.faces = 80});
  for (Vec3& p : asset.hull.positions)
    p *= 1.4f;
  Material material;
  material.name = "hull";
  asset.hull.materials = {material};
  asset.levels = {level_of(bumpy_sphere(faces), 0.0f), level_of(bumpy_sphere(faces / 4), 0.05f)};
  asset.bounds = face_bounds(asset.levels[0].mesh);
  asset.maps.normals = noisy_image(16, 8, 1);
  asset.maps.colors = noisy_image(5, 7, 2);
  asset.maps.displacement_width = 9;
  asset.maps.displacement_height = 6;
  for (int i = 0; i < 9 * 6; ++i)
    asset.maps.displacement.push_back(static_cast<std::uint16_t>(i % 9 == 4 ? 65535 : 1000 + 37 * i % 512));
  asset.maps.displacement_low = -0.1f / 3.0f;
  asset.maps.displacement_high = 0.0f;
  return asset;
}

}  // namespace limn::test
