#include "limn/refine/attributes.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "limn/base/random.h"
#include "limn/refine/refine.h"

namespace limn {
namespace {

/// A flat grid whose faces start at any of their corners, so that edges run both ways; texture coordinates and colours
/// are affine in the position, with a seam of other values down the middle.
Mesh flat_grid(Random& random) {
  Mesh mesh;
  constexpr VertexId kSide = 6;
  for (VertexId y = 0; y <= kSide; ++y) {
    for (VertexId x = 0; x <= kSide; ++x)
      mesh.positions.emplace_back(x, y, 0);
  }
  const auto add = [&](const Triangle& t, bool right) {
    const std::size_t turn = random.below(3);
    Triangle& face = mesh.faces.emplace_back();
    for (std::size_t c = 0; c < 3; ++c) {
      face[c] = t[(c + turn) % 3];
      const Vec3 p = mesh.positions[face[c]];
      mesh.uvs.indices.push_back(static_cast<std::uint32_t>(mesh.uvs.values.size()));
      mesh.uvs.values.emplace_back(0.1f * p.x + (right ? 5.0f : 0.0f), 0.2f * p.y - 0.05f * p.x);
    }
  };
  for (VertexId y = 0; y < kSide; ++y) {
    for (VertexId x = 0; x < kSide; ++x) {
      const VertexId v = y * (kSide + 1) + x;
      const bool right = x >= kSide / 2;
      add({v, v + 1, v + kSide + 2}, right);
      add({v, v + kSide + 2, v + kSide + 1}, right);
    }
  }
  for (const Vec3& p : mesh.positions)
    mesh.colors.values.emplace_back(p.x / 6, p.y / 6, 0.5f, 1.0f);
  mesh.normals.values.assign(mesh.positions.size(), Vec3(0, 0, 1));
  return mesh;
}

TEST(AttributeTessellator, PutsEachValueAtItsPointWhicheverWayAnEdgeRuns) {
  Random random(3);
  for (int round = 0; round < 10; ++round) {
    const Mesh mesh = flat_grid(random);
    const Refiner refiner = Refiner::create(mesh).value();
    std::vector<float> levels(refiner.topology().edge_count());
    for (float& level : levels)
      level = static_cast<float>(random.uniform(0.0, 3.0));
    const Refinement result = refiner.refine_with(levels).value();
    for (FaceId f = 0; f < result.mesh.faces.size(); ++f) {
      const bool right = mesh.corner(mesh.uvs, result.source_face[f], 0).x > 4.0f;
      for (int c = 0; c < 3; ++c) {
        const Vec3 p = result.mesh.positions[result.mesh.faces[f][static_cast<std::size_t>(c)]];
        const Vec2 uv = result.mesh.corner(result.mesh.uvs, f, c);
        ASSERT_NEAR(uv.x, 0.1f * p.x + (right ? 5.0f : 0.0f), 2e-6f);
        ASSERT_NEAR(uv.y, 0.2f * p.y - 0.05f * p.x, 2e-6f);
        ASSERT_LT(glm::length(result.mesh.corner(result.mesh.colors, f, c) - Vec4(p.x / 6, p.y / 6, 0.5f, 1.0f)),
                  1e-6f);
      }
    }
  }
}

TEST(AttributeTessellator, BendsNormalsTheSameWayFromBothSidesOfAnEdge) {
  Random random(4);
  Mesh mesh = flat_grid(random);
  for (Vec3& n : mesh.normals.values)
    n = glm::normalize(Vec3(0, 0, 1) + 0.3f * random.direction());
  const Refiner refiner = Refiner::create(mesh).value();
  const std::vector<float> levels(refiner.topology().edge_count(), 2.0f);
  const Mesh result = refiner.refine_with(levels).value().mesh;
  // One normal a position: a value taken at the mirrored point of an edge would give two.
  std::vector<std::uint32_t> normal_of(result.positions.size(), kInvalidId);
  for (FaceId f = 0; f < result.faces.size(); ++f) {
    for (int c = 0; c < 3; ++c) {
      std::uint32_t& seen = normal_of[result.faces[f][static_cast<std::size_t>(c)]];
      const std::uint32_t index = result.corner_index(result.normals, f, c);
      if (seen == kInvalidId) seen = index;
      EXPECT_EQ(result.normals.values[seen], result.normals.values[index]);
    }
  }
}

}  // namespace
}  // namespace limn
