// Tiles: bilinear lookups in every mip level up to the clean one read nothing of a neighbour. And texels of a mesh's
// own texture coordinates.
#include "limn/bake/tiles.h"

#include <array>
#include <cmath>
#include <gtest/gtest.h>

#include "limn/base/random.h"

#include "bake/shapes.h"

namespace limn::bake_detail {
namespace {

/// Whether all texels of the picture that a texel of a mip level is the mean of belong to the face.
bool all_of(const TexelMap& map, FaceId face, int level, int x, int y) {
  const int side = 1 << level;
  for (int dy = 0; dy < side; ++dy) {
    for (int dx = 0; dx < side; ++dx) {
      const std::size_t row = static_cast<std::size_t>(y * side + dy);
      const std::size_t column = static_cast<std::size_t>(x * side + dx);
      if (map.owner[row * static_cast<std::size_t>(map.size_px) + column] != face) return false;
    }
  }
  return true;
}

/// Whether a bilinear lookup there, in texels of the level, reads the face's texels alone.
bool reads_only(const TexelMap& map, FaceId face, int level, glm::dvec2 at) {
  at = at / double(1 << level) - 0.5;
  const glm::dvec2 low = glm::floor(at), share = at - low;
  for (int dy = 0; dy < 2; ++dy) {
    for (int dx = 0; dx < 2; ++dx) {
      const double weight = (dx == 1 ? share.x : 1.0 - share.x) * (dy == 1 ? share.y : 1.0 - share.y);
      if (weight > 1e-9 && !all_of(map, face, level, int(low.x) + dx, int(low.y) + dy)) return false;
    }
  }
  return true;
}

glm::dvec2 random_point(const Mesh& mesh, const CornerAttribute<Vec2>& uvs, FaceId face, int size_px, Random& random) {
  double u = random.uniform(), v = random.uniform();
  if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
  // Borders and corners are where neighbours would be read.
  if (random.below(2) == 0) u = 0.0;
  if (random.below(4) == 0) v = 1.0 - u;
  if (random.below(4) == 0) v = 0.0;
  const glm::dvec2 uv = glm::dvec2(mesh.corner(uvs, face, 0)) * (1.0 - u - v) +
                        glm::dvec2(mesh.corner(uvs, face, 1)) * u + glm::dvec2(mesh.corner(uvs, face, 2)) * v;
  return glm::dvec2(uv.x, 1.0 - uv.y) * double(size_px);
}

TEST(Tiles, AreNotMixedWithTheirNeighboursUpToTheCleanMipLevel) {
  Random random(1);
  for (const auto& [faces, size, level] : {std::array{20, 64, 0},
                                           {20, 64, 1},
                                           {20, 128, 2},
                                           {320, 512, 1},
                                           {321, 1024, 3},
                                           {20, 256, -1},
                                           {1, 16, 0},
                                           {1, 64, 4}}) {
    Mesh mesh = test::sphere(static_cast<std::size_t>(std::max(faces, 20)));
    mesh.faces.resize(static_cast<std::size_t>(faces), mesh.faces[0]);
    const Result<TileLayout> layout = plan_tiles(mesh.faces.size(), size, level);
    ASSERT_TRUE(layout) << faces << " " << size << " " << level;
    const CornerAttribute<Vec2> uvs = tile_uvs(mesh, *layout);
    const TexelMap map = tile_texels(mesh, uvs, *layout);
    for (int i = 0; i < 20000; ++i) {
      const auto face = static_cast<FaceId>(random.below(mesh.faces.size()));
      const glm::dvec2 at = random_point(mesh, uvs, face, size, random);
      for (int k = 0; k <= layout->clean_mip_level; ++k) {
        ASSERT_TRUE(reads_only(map, face, k, at))
            << faces << " faces, size " << size << ", level " << k << ", at " << at.x << ", " << at.y;
      }
    }
  }
}

TEST(Tiles, AreAsLargeAsTheBudgetAllows) {
  for (const auto& row : {std::array{500, 1024}, {4000, 1024}, {4000, 2048}, {20, 64}}) {
    const int faces = row[0], size = row[1];
    const auto layout = plan_tiles(static_cast<std::size_t>(faces), size, 0);
    ASSERT_TRUE(layout);
    const auto squares = [&](int tile) { return (size / tile) * (size / tile); };
    EXPECT_GE(2 * squares(layout->tile_px), faces);
    EXPECT_LT(2 * squares(layout->tile_px + 1), faces);
    EXPECT_EQ(layout->leg_px, layout->tile_px - 3);
  }
  // Room for legs of 50 texels at least: the automatic choice keeps mip levels clean where that costs little.
  const auto automatic = plan_tiles(500, 1024, -1);
  ASSERT_TRUE(automatic);
  EXPECT_GE(automatic->clean_mip_level, 1);
  EXPECT_GE(8 * automatic->leg_px, 7 * automatic->tile_px);
}

TEST(Tiles, SayWhichSizeIsNeeded) {
  const auto layout = plan_tiles(1'000'000, 1024, -1);
  ASSERT_FALSE(layout);
  EXPECT_EQ(layout.error().code, ErrorCode::kInvalidArgument);
  EXPECT_NE(layout.error().remedy.find("4096"), std::string::npos) << layout.error().remedy;
  EXPECT_TRUE(plan_tiles(1'000'000, 4096, -1));
}

double turn(const Mesh& mesh, const CornerAttribute<Vec2>& uvs, FaceId face) {
  const glm::dvec2 a(mesh.corner(uvs, face, 0));
  const glm::dvec2 b = glm::dvec2(mesh.corner(uvs, face, 1)) - a, c = glm::dvec2(mesh.corner(uvs, face, 2)) - a;
  return b.x * c.y - b.y * c.x;
}

TEST(Tiles, AreOfOneSizeAndNotMirrored) {
  const Mesh mesh = test::shape(Shape::kKnot, 601);
  const auto layout = plan_tiles(mesh.faces.size(), 512, -1);
  ASSERT_TRUE(layout);
  const CornerAttribute<Vec2> uvs = tile_uvs(mesh, *layout);
  const double expected = std::pow(double(layout->leg_px) / layout->size_px, 2);
  for (FaceId face = 0; face < mesh.faces.size(); ++face)
    ASSERT_NEAR(turn(mesh, uvs, face), expected, 1e-6);
}

/// The nearest place of a triangle to the texel, found by trying 200 × 200 of them.
TEST(TexelFrame, GivesTheNearestPointOfTheTriangle) {
  Random random(2);
  for (int round = 0; round < 20; ++round) {
    glm::dvec2 corners[3];
    for (glm::dvec2& corner : corners)
      corner = {random.uniform(0, 30), random.uniform(0, 30)};
    const TexelFrame frame(corners);
    const glm::dvec2 at(random.uniform(-10, 40), random.uniform(-10, 40));
    const Barycentric found = frame.at(float(at.x), float(at.y));
    const auto place = [&](double u, double v) { return corners[0] * (1.0 - u - v) + corners[1] * u + corners[2] * v; };
    double best = 1e300;
    for (int i = 0; i <= 200; ++i) {
      for (int j = 0; j <= 200 - i; ++j) {
        const glm::dvec2 d = place(i / 200.0, j / 200.0) - at;
        best = std::min(best, std::sqrt(d.x * d.x + d.y * d.y));
      }
    }
    const glm::dvec2 d = place(double(found.u), double(found.v)) - at;
    EXPECT_NEAR(std::sqrt(d.x * d.x + d.y * d.y), best, 0.3);
    EXPECT_GE(found.u, 0.0f);
    EXPECT_GE(found.v, 0.0f);
    EXPECT_LE(found.u + found.v, 1.0001f);
  }
}

Mesh square(float left, float bottom, float right, float top) {
  Mesh mesh;
  mesh.positions = {Vec3(0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)};
  mesh.faces = {{0, 1, 2}, {0, 2, 3}};
  mesh.uvs.values = {Vec2(left, bottom), Vec2(right, bottom), Vec2(right, top), Vec2(left, top)};
  return mesh;
}

std::size_t owned(const TexelMap& map) {
  std::size_t count = 0;
  for (const FaceId face : map.owner)
    count += face != kInvalidId ? 1 : 0;
  return count;
}

TEST(UvTexels, CoverAnIslandOnceAndGrowItsGutter) {
  const Mesh mesh = square(0.25f, 0.25f, 0.75f, 0.75f);
  const auto bare = uv_texels(mesh, 64, 0);
  ASSERT_TRUE(bare);
  EXPECT_EQ(owned(*bare), 32u * 32u);
  EXPECT_EQ(bare->overlapping, 0u);
  const auto grown = uv_texels(mesh, 64, 3);
  ASSERT_TRUE(grown);
  EXPECT_EQ(owned(*grown), 38u * 38u);
  // v grows upwards: the lower face's texels lie in later rows.
  EXPECT_EQ(bare->owner[47 * 64 + 47], 0u);
  EXPECT_EQ(bare->owner[16 * 64 + 16], 1u);
}

TEST(UvTexels, KeepEveryTexelThatAThinFaceTouches) {
  Mesh mesh = square(0.1f, 0.5f + 0.002f, 0.9f, 0.5f + 0.004f);
  const auto map = uv_texels(mesh, 64, 0);
  ASSERT_TRUE(map);
  EXPECT_GE(owned(*map), 51u);
  EXPECT_LE(owned(*map), 54u);
}

TEST(UvTexels, CountOverlapsAndLeaveTheFirstFace) {
  Mesh mesh = square(0.25f, 0.25f, 0.75f, 0.75f);
  mesh.faces.push_back({0, 1, 2});
  const auto map = uv_texels(mesh, 64, 2);
  ASSERT_TRUE(map);
  EXPECT_GT(map->overlapping, 450u);
  EXPECT_LE(map->overlapping, 512u);
  for (const FaceId face : map->owner)
    ASSERT_NE(face, 2u);
}

TEST(UvTexels, RepeatOutsideOfThePicture) {
  const Mesh mesh = square(0.75f, -0.5f, 1.25f, 0.0f);
  const auto map = uv_texels(mesh, 64, 0);
  ASSERT_TRUE(map);
  EXPECT_EQ(owned(*map), 32u * 32u);
  EXPECT_EQ(map->overlapping, 0u);
  // (0.1, 0.9) is (1.1, −0.1): near the top right of the island.
  const FaceId face = map->owner[6 * 64 + 6];
  ASSERT_NE(face, kInvalidId);
  const Barycentric at = map->at(face, 6.5f, 6.5f);
  const Vec2 uv = mesh.corner(mesh.uvs, face, 0) * (1.0f - at.u - at.v) + mesh.corner(mesh.uvs, face, 1) * at.u +
                  mesh.corner(mesh.uvs, face, 2) * at.v;
  EXPECT_NEAR(uv.x, 1.0f + 6.5f / 64, 1e-5f);
  EXPECT_NEAR(uv.y, -6.5f / 64, 1e-5f);
}

TEST(UvTexels, RefuseCoordinatesThatAreNone) {
  Mesh mesh = square(0, 0, 1, 1);
  for (const Vec2 bad : {Vec2(NAN, 0), Vec2(0, INFINITY), Vec2(20, 0), Vec2(1e30f, 0)}) {
    mesh.uvs.values[3] = bad;
    const auto map = uv_texels(mesh, 64, 0);
    ASSERT_FALSE(map);
    EXPECT_EQ(map.error().code, ErrorCode::kUnsuitable);
    EXPECT_EQ(map.error().where, "face 1");
  }
}

}  // namespace
}  // namespace limn::bake_detail
