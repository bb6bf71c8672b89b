// MikkTSpace: known frames, mirrored and broken texture coordinates, and the way there and back.
#include "limn/bake/tangent_space.h"

#include <cmath>
#include <gtest/gtest.h>

#include "limn/bake/surface.h"
#include "limn/base/random.h"

#include "bake/shapes.h"
#include "support/stable.h"

namespace limn::bake_detail {
namespace {

Mesh square() {
  Mesh mesh;
  mesh.positions = {Vec3(0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)};
  mesh.faces = {{0, 1, 2}, {0, 2, 3}};
  mesh.uvs.values = {Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1)};
  mesh.normals.values.assign(4, Vec3(0, 0, 1));
  return mesh;
}

void expect_tangents(const Mesh& mesh, const Vec4& expected) {
  for (const Vec4& tangent : mikk_tangents(mesh, mesh.normals)) {
    EXPECT_LT(glm::length(Vec3(tangent) - Vec3(expected)), 1e-6f);
    EXPECT_EQ(tangent.w, expected.w);
  }
}

TEST(MikkTangents, RunAlongGrowingU) {
  Mesh mesh = square();
  expect_tangents(mesh, Vec4(1, 0, 0, 1));
  for (Vec2& uv : mesh.uvs.values)
    uv = Vec2(uv.y, -uv.x);
  expect_tangents(mesh, Vec4(0, 1, 0, 1));
}

TEST(MikkTangents, OfMirroredCoordinatesHaveTheOtherSide) {
  Mesh mesh = square();
  for (Vec2& uv : mesh.uvs.values)
    uv.x = -uv.x;
  expect_tangents(mesh, Vec4(-1, 0, 0, -1));
}

TEST(MikkTangents, AreNotJoinedAcrossAMirroringEdge) {
  // Two squares side by side, the right one's u running back to the left.
  Mesh mesh;
  mesh.positions = {Vec3(0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0), Vec3(2, 0, 0), Vec3(2, 1, 0)};
  mesh.faces = {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}};
  mesh.uvs.values = {Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1), Vec2(0, 0), Vec2(0, 1)};
  mesh.normals.values.assign(6, Vec3(0, 0, 1));
  const std::vector<Vec4> tangents = mikk_tangents(mesh, mesh.normals);
  for (std::size_t corner = 0; corner < 12; ++corner) {
    const float side = corner < 6 ? 1.0f : -1.0f;
    EXPECT_LT(glm::length(Vec3(tangents[corner]) - Vec3(side, 0, 0)), 1e-6f) << corner;
    EXPECT_EQ(tangents[corner].w, side) << corner;
  }
}

TEST(MikkTangents, WeighAnglesNotNumbersOfFaces) {
  // Cutting a face in two at a vertex changes nothing there: angles add up.
  Mesh mesh = square();
  for (Vec3& p : mesh.positions)
    p.z = p.x * p.y;
  mesh.normals.values.assign(4, glm::normalize(Vec3(-0.3f, -0.3f, 1)));
  const Vec4 whole = mikk_tangents(mesh, mesh.normals)[0];
  Mesh cut = mesh;
  cut.positions.push_back((mesh.positions[1] + mesh.positions[2]) * 0.5f);
  cut.uvs.values.push_back((mesh.uvs.values[1] + mesh.uvs.values[2]) * 0.5f);
  cut.normals.values.push_back(mesh.normals.values[0]);
  cut.faces = {{0, 1, 4}, {0, 4, 2}, {0, 2, 3}};
  const Vec4 halves = mikk_tangents(cut, cut.normals)[0];
  EXPECT_LT(glm::length(whole - halves), 1e-3f);
}

TEST(MikkTangents, OfFacesWithoutExtentComeFromTheirNeighbours) {
  Mesh mesh = square();
  mesh.faces.push_back({1, 1, 2});
  const std::vector<Vec4> tangents = mikk_tangents(mesh, mesh.normals);
  for (std::size_t corner = 6; corner < 9; ++corner)
    EXPECT_LT(glm::length(tangents[corner] - Vec4(1, 0, 0, 1)), 1e-6f);
}

TEST(MikkTangents, AreNumbersForAwkwardMeshes) {
  Random random(3);
  for (const test::StableMesh& awkward : test::awkward_meshes()) {
    Mesh mesh = awkward.mesh;
    mesh.uvs.indices.clear();
    mesh.uvs.values.resize(mesh.positions.size());
    for (Vec2& uv : mesh.uvs.values)
      uv = Vec2(float(random.below(3)), float(random.below(3)));
    for (const Vec4& tangent : mikk_tangents(mesh, usable_normals(mesh, 4.0f))) {
      const float length = glm::length(Vec3(tangent));
      EXPECT_TRUE(std::abs(length - 1.0f) < 1e-4f || length == 0.0f) << awkward.name;
      EXPECT_EQ(std::abs(tangent.w), 1.0f);
    }
  }
}

TEST(TangentFrame, TakesNormalsThereAndBack) {
  Random random(4);
  for (int i = 0; i < 1000; ++i) {
    Vec4 tangents[3];
    Vec3 normals[3];
    const Vec3 n = random.direction();
    const float side = i % 2 == 0 ? 1.0f : -1.0f;
    const Vec3 t = glm::normalize(glm::cross(n, random.direction()));
    for (int c = 0; c < 3; ++c) {
      normals[c] = glm::normalize(n + 0.4f * random.direction());
      tangents[c] = Vec4(glm::normalize(t + 0.4f * random.direction()), side);
    }
    const TangentFrame frame = interpolated_frame(tangents, normals, 0.3f, 0.2f);
    const Vec3 wanted = random.direction();
    EXPECT_LT(glm::length(out_of_frame(frame, into_frame(frame, wanted)) - wanted), 2e-4f);
  }
}

TEST(TangentFrame, WithoutExtentGivesThePlainNormal) {
  TangentFrame frame;
  frame.tangent = Vec3(0);
  EXPECT_EQ(into_frame(frame, Vec3(1, 0, 0)), Vec3(0, 0, 1));
}

/// The barycentric coordinates of a texel's centre in its face.
Vec2 place_in(const Mesh& mesh, FaceId face, int x, int y, int size) {
  const glm::dvec2 at((x + 0.5) / size, 1.0 - (y + 0.5) / size);
  const glm::dvec2 a(mesh.corner(mesh.uvs, face, 0));
  const glm::dvec2 e1 = glm::dvec2(mesh.corner(mesh.uvs, face, 1)) - a;
  const glm::dvec2 e2 = glm::dvec2(mesh.corner(mesh.uvs, face, 2)) - a;
  const double area = e1.x * e2.y - e1.y * e2.x;
  return {((at - a).x * e2.y - (at - a).y * e2.x) / area, (e1.x * (at - a).y - e1.y * (at - a).x) / area};
}

void expect_maps_agree(const Mesh& high, const Mesh& low) {
  BakeOptions options;
  options.size_px = 256;
  options.maps.tangent_normals = true;
  const auto maps = test::baked(high, low, options);
  ASSERT_TRUE(maps);
  const Mesh& mesh = maps->mesh;
  std::size_t compared = 0;
  for (int y = 0; y < 256; ++y) {
    for (int x = 0; x < 256; ++x) {
      const std::size_t i = 256 * std::size_t(y) + std::size_t(x);
      const FaceId face = maps->owner[i];
      if (face == kInvalidId) continue;
      const Vec2 at = place_in(mesh, face, x, y, 256);
      if (at.x < 0.0f || at.y < 0.0f || at.x + at.y > 1.0f) continue;
      Vec4 tangents[3];
      Vec3 normals[3];
      for (int c = 0; c < 3; ++c) {
        tangents[c] = maps->tangents[3 * std::size_t{face} + static_cast<std::size_t>(c)];
        normals[c] = mesh.corner(mesh.normals, face, c);
      }
      const Vec3 seen =
          out_of_frame(interpolated_frame(tangents, normals, at.x, at.y), test::vector_at(maps->tangent_normals, i));
      ASSERT_LT(glm::length(seen - test::vector_at(maps->object_normals, i)), 1e-3f) << x << ", " << y;
      ++compared;
    }
  }
  EXPECT_GT(compared, 20'000u);
}

TEST(TangentNormals, DecodeToTheObjectNormals) {
  const Mesh high = test::shape(Shape::kKnot, 20000);
  Mesh low = test::shape(Shape::kKnot, 500);
  expect_maps_agree(high, low);
  Mesh mirrored = low;
  for (Vec2& uv : mirrored.uvs.values)
    uv.x = 1.0f - uv.x;
  expect_maps_agree(high, mirrored);
  low.uvs = {};
  expect_maps_agree(high, low);
}

}  // namespace
}  // namespace limn::bake_detail
