// Maps hold what the high mesh has: analytic spheres, identical meshes, awkward meshes.
#include "limn/bake/bake.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "limn/bake/discontinuity.h"
#include "limn/base/parallel.h"
#include "limn/image/srgb.h"
#include "limn/mesh/normals.h"

#include "bake/shapes.h"
#include "support/mesh_bits.h"
#include "support/stable.h"

namespace limn {
namespace {

using test::baked;
using test::vector_at;

TEST(Bake, ASphereInAnIcosahedronGivesItsNormals) {
  BakeOptions options;
  options.size_px = 256;
  options.maps.positions = options.maps.displacement = true;
  const auto maps = baked(test::sphere(20480), test::cage(), options);
  ASSERT_TRUE(maps);
  EXPECT_EQ(maps->report.misses, 0u);
  EXPECT_GT(maps->report.texels, 40'000u);
  EXPECT_LT(maps->report.worst_distance, 0.3001);
  EXPECT_GT(maps->report.worst_distance, 0.2990);
  for (std::size_t i = 0; i < maps->owner.size(); ++i) {
    const Vec3 normal = vector_at(maps->object_normals, i);
    ASSERT_NEAR(glm::length(normal), 1.0f, 1e-5f);
    if (maps->owner[i] == kInvalidId) continue;
    const Vec3 at = vector_at(maps->positions, i);
    ASSERT_GT(glm::dot(normal, glm::normalize(at)), 0.9999f) << i;
    ASSERT_LT(maps->displacement.values[i], 0.0f) << i;
  }
}

/// The low mesh's point and normal at a texel's centre, from its texture coordinates; false in gutters.
bool low_point(const Mesh& low, FaceId face, int x, int y, int size, Vec3& position, Vec3& normal) {
  const glm::dvec2 at((x + 0.5) / size, 1.0 - (y + 0.5) / size);
  const glm::dvec2 a(low.corner(low.uvs, face, 0));
  const glm::dvec2 e1 = glm::dvec2(low.corner(low.uvs, face, 1)) - a, e2 = glm::dvec2(low.corner(low.uvs, face, 2)) - a;
  const double area = e1.x * e2.y - e1.y * e2.x;
  const float u = static_cast<float>(((at - a).x * e2.y - (at - a).y * e2.x) / area);
  const float v = static_cast<float>((e1.x * (at - a).y - e1.y * (at - a).x) / area);
  if (u < 0.0f || v < 0.0f || u + v > 1.0f) return false;
  const Triangle& t = low.faces[face];
  position = low.positions[t[0]] * (1 - u - v) + low.positions[t[1]] * u + low.positions[t[2]] * v;
  normal = glm::normalize(low.corner(low.normals, face, 0) * (1 - u - v) + low.corner(low.normals, face, 1) * u +
                          low.corner(low.normals, face, 2) * v);
  return true;
}

TEST(Bake, IdenticalMeshesGiveIdenticalAttributes) {
  Mesh mesh = test::shape(Shape::kKnot, 1000);
  mesh.uvs = {};
  mesh.colors.values.resize(mesh.positions.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    mesh.colors.values[i] = Vec4(mesh.positions[i] * 0.4f + 0.5f, 1.0f);
  BakeOptions options;
  options.size_px = 512;
  options.maps.colors = options.maps.displacement = options.maps.positions = true;
  const auto maps = baked(mesh, mesh, options);
  ASSERT_TRUE(maps);
  EXPECT_EQ(maps->report.misses, 0u);
  EXPECT_LT(maps->report.worst_distance, 1e-4);
  std::size_t compared = 0;
  for (int y = 0; y < 512; ++y) {
    for (int x = 0; x < 512; ++x) {
      const std::size_t i = 512 * std::size_t(y) + std::size_t(x);
      Vec3 position, normal;
      if (maps->owner[i] == kInvalidId || !low_point(maps->mesh, maps->owner[i], x, y, 512, position, normal)) continue;
      ++compared;
      ASSERT_LT(glm::length(vector_at(maps->positions, i) - position), 1e-4f);
      ASSERT_LT(glm::length(vector_at(maps->object_normals, i) - normal), 2e-3f);
      const float* const color = maps->colors.pixel(x, y);
      ASSERT_LT(glm::length(Vec3(color[0], color[1], color[2]) - (position * 0.4f + 0.5f)), 1e-4f);
      ASSERT_LT(std::abs(maps->displacement.values[i]), 1e-4f);
    }
  }
  EXPECT_GT(compared, 100'000u);
}

TEST(Bake, ALowMeshInsideShootsOutwards) {
  Mesh low = test::cage();
  for (Vec3& p : low.positions)
    p *= 0.5f;
  BakeOptions options;
  options.size_px = 128;
  options.maps.displacement = true;
  const auto maps = baked(test::sphere(5120), low, options);
  ASSERT_TRUE(maps);
  EXPECT_EQ(maps->report.misses, 0u);
  EXPECT_GT(maps->report.displacement_high, 0.3);
  for (std::size_t i = 0; i < maps->owner.size(); ++i) {
    if (maps->owner[i] == kInvalidId) continue;
    ASSERT_GT(maps->displacement.values[i], 0.0f);
  }
}

/// A thin plate: from outside its near side, from between its sides the one that the normal points to.
Mesh plate(float half) {
  Mesh mesh;
  for (const float z : {-half, half}) {
    for (const Vec2 p : {Vec2(-1, -1), Vec2(1, -1), Vec2(1, 1), Vec2(-1, 1)})
      mesh.positions.emplace_back(p, z);
  }
  mesh.faces = {{4, 5, 6}, {4, 6, 7}, {0, 2, 1}, {0, 3, 2}};
  for (unsigned i = 0; i < 4; ++i) {
    const unsigned j = (i + 1) % 4;
    mesh.faces.push_back({i, j, j + 4});
    mesh.faces.push_back({i, j + 4, i + 4});
  }
  mesh.normals = crease_normals(mesh, build_topology(mesh), 0.5f);
  return mesh;
}

Mesh sheet(float z) {
  Mesh mesh;
  mesh.positions = {Vec3(-0.5f, -0.5f, z), Vec3(0.5f, -0.5f, z), Vec3(0.5f, 0.5f, z), Vec3(-0.5f, 0.5f, z)};
  mesh.faces = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

TEST(Bake, NeverTakesTheFarSideOfAThinPart) {
  BakeOptions options;
  options.size_px = 32;
  options.maps.displacement = true;
  for (const float z : {0.3f, 0.011f, 0.009f, 0.0f, -0.009f}) {
    const auto maps = baked(plate(0.01f), sheet(z), options);
    ASSERT_TRUE(maps);
    EXPECT_EQ(maps->report.misses, 0u) << z;
    for (std::size_t i = 0; i < maps->owner.size(); ++i) {
      if (maps->owner[i] == kInvalidId) continue;
      ASSERT_NEAR(maps->displacement.values[i], 0.01f - z, 1e-5f) << z;
      ASSERT_GT(maps->object_normals.values[3 * i + 2], 0.999f) << z;
    }
  }
  // Below the plate, looking up: its lower side is turned the wrong way, and the closest point counts as a miss.
  const auto below = baked(plate(0.01f), sheet(-0.3f), options);
  ASSERT_TRUE(below);
  EXPECT_EQ(below->report.misses, below->report.samples);
  EXPECT_EQ(below->report.miss_share(), 1.0);
}

TEST(Bake, ABoundMakesMissesOfLongRays) {
  BakeOptions options;
  options.size_px = 64;
  options.max_distance = 0.25;
  const auto maps = baked(test::sphere(5120), test::cage(), options);
  ASSERT_TRUE(maps);
  EXPECT_GT(maps->report.misses, 0u);
  EXPECT_LT(maps->report.misses, maps->report.samples / 2);
}

TEST(Bake, TheClosestPointIsNeverFartherThanTheHit) {
  BakeOptions options;
  options.size_px = 128;
  options.maps.positions = true;
  const Mesh high = test::shape(Shape::kKnot, 6000);
  Mesh low = test::shape(Shape::kKnot, 300);
  low.uvs = {};
  const auto shot = baked(high, low, options);
  options.method = BakeMethod::kClosest;
  const auto closest = baked(high, low, options);
  ASSERT_TRUE(shot && closest);
  EXPECT_EQ(closest->report.misses, 0u);
  EXPECT_LE(closest->report.worst_distance, shot->report.worst_distance);
  EXPECT_EQ(closest->report.samples, shot->report.samples);
}

TEST(Bake, OwnTextureCoordinatesAreKept) {
  const Mesh low = test::shape(Shape::kTorus, 400);
  ASSERT_FALSE(low.uvs.empty());
  BakeOptions options;
  options.size_px = 256;
  options.maps.positions = true;
  const auto maps = baked(test::shape(Shape::kTorus, 40000), low, options);
  ASSERT_TRUE(maps);
  EXPECT_TRUE(test::same_bits(maps->mesh.uvs.values, low.uvs.values));
  EXPECT_EQ(maps->report.tile_px, 0);
  EXPECT_EQ(maps->report.overlapping_texels, 0u);
  for (std::size_t i = 0; i < maps->owner.size(); ++i) {
    if (maps->owner[i] == kInvalidId) continue;
    ASSERT_GT(glm::length(vector_at(maps->positions, i)), 0.1f);
  }
  options.layout = BakeLayout::kTiles;
  const auto tiled = baked(test::shape(Shape::kTorus, 40000), low, options);
  ASSERT_TRUE(tiled);
  EXPECT_GT(tiled->report.tile_px, 0);
}

TEST(Bake, SamplesAverage) {
  BakeOptions options;
  options.size_px = 64;
  options.maps.colors = options.maps.displacement = true;
  Mesh high = test::shape(Shape::kTerrain, 20000);
  high.colors.values.assign(high.positions.size(), Vec4(0.25f, 0.5f, 1.0f, 1.0f));
  const Mesh low = test::shape(Shape::kTerrain, 100);
  for (const int samples : {1, 4, 16}) {
    options.samples = samples;
    const auto maps = baked(high, low, options);
    ASSERT_TRUE(maps);
    EXPECT_EQ(maps->report.samples, maps->report.texels * static_cast<std::size_t>(samples));
    for (std::size_t i = 0; i < maps->owner.size(); ++i) {
      ASSERT_NEAR(glm::length(vector_at(maps->object_normals, i)), 1.0f, 1e-5f);
      if (maps->owner[i] == kInvalidId) continue;
      ASSERT_NEAR(maps->colors.values[4 * i + 1], 0.5f, 1e-5f);
    }
  }
}

TEST(Bake, OcclusionKnowsTheOpenAndTheInside) {
  BakeOptions options;
  options.size_px = 64;
  options.maps.occlusion = true;
  const auto open = baked(test::sphere(5120), test::cage(), options);
  ASSERT_TRUE(open);
  double sum = 0;
  for (const float value : open->occlusion.values)
    sum += value;
  EXPECT_GT(sum / static_cast<double>(open->occlusion.values.size()), 0.98);
  // Seen from inside, a sphere closes everything off.
  Mesh hollow = test::sphere(5120), low = test::cage();
  for (Mesh* mesh : {&hollow, &low}) {
    for (Triangle& t : mesh->faces)
      std::swap(t[1], t[2]);
    for (Vec3& n : mesh->normals.values)
      n = -n;
  }
  for (Vec3& p : low.positions)
    p *= 0.5f;
  const auto closed = baked(hollow, low, options);
  ASSERT_TRUE(closed);
  for (std::size_t i = 0; i < closed->owner.size(); ++i) {
    if (closed->owner[i] == kInvalidId) continue;
    ASSERT_LT(closed->occlusion.values[i], 0.05f);
  }
}

/// Two plates, one far below the other and beyond its edge: rays past the upper one meet the lower.
TEST(Bake, ALongRayGivesWayToAPointThatIsFarNearer) {
  Mesh high;
  high.positions = {Vec3(-1, -1, 0),  Vec3(0, -1, 0),  Vec3(0, 1, 0),  Vec3(-1, 1, 0),
                    Vec3(-1, -1, -2), Vec3(1, -1, -2), Vec3(1, 1, -2), Vec3(-1, 1, -2)};
  high.faces = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
  BakeOptions options;
  options.size_px = 64;
  options.maps.displacement = true;
  const Mesh low = sheet(0.1f);
  options.most_stretch = 0;
  const auto published = baked(high, low, options);
  options.most_stretch = 2;
  const auto ruled = baked(high, low, options);
  ASSERT_TRUE(published && ruled);
  EXPECT_EQ(published->report.overruled, 0u);
  EXPECT_NEAR(published->report.worst_distance, 2.1, 1e-4);
  EXPECT_GT(ruled->report.overruled, ruled->report.samples / 4);
  EXPECT_EQ(ruled->report.misses, 0u);
  EXPECT_LT(ruled->report.worst_distance, 0.6);
  options.most_stretch = 0.5;
  EXPECT_FALSE(bake(high, low, options));
}

TEST(Bake, DiscontinuitiesAreCountedWhereTheMapIsTorn) {
  // A step of height 1 in a sheet that is open between: rays fall on one part or the other.
  Mesh high = sheet(0.0f);
  for (Vec3& p : high.positions)
    p.x = p.x < 0 ? -0.5f : 0.0f;
  const Mesh other = sheet(-1.0f);
  for (const Vec3& p : other.positions)
    high.positions.push_back(p);
  high.faces.push_back({4, 5, 6});
  high.faces.push_back({4, 6, 7});
  BakeOptions options;
  options.size_px = 64;
  options.most_stretch = 0;
  options.maps.positions = true;
  const auto torn = baked(high, sheet(0.2f), options);
  const auto whole = baked(other, sheet(0.2f), options);
  ASSERT_TRUE(torn && whole);
  const auto breaks = find_discontinuities(*torn, 8.0), none = find_discontinuities(*whole, 8.0);
  ASSERT_TRUE(breaks && none);
  EXPECT_EQ(none->breaks, 0u);
  EXPECT_GT(none->pairs, 1000u);
  EXPECT_GT(breaks->breaks, 40u);
  EXPECT_LT(breaks->breaks, 200u);
  options.maps.positions = false;
  EXPECT_FALSE(find_discontinuities(*baked(other, sheet(0.2f), options), 8.0));
}

TEST(Bake, PicturesOfTheHighMeshComeThroughInLinearLight) {
  // Left half dark, right half bright, u along x.
  Image picture(64, 64);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const std::uint8_t value = x < 32 ? 55 : 188;
      const std::uint8_t bytes[4] = {value, value, value, 255};
      std::copy_n(bytes, 4, picture.pixel(x, y));
    }
  }
  const auto png = encode_png(picture);
  ASSERT_TRUE(png);
  Mesh high = sheet(0.0f);
  high.uvs.values = {Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1)};
  high.materials.resize(1);
  high.materials[0].base_color = Vec4(1.0f, 0.5f, 1.0f, 1.0f);
  const auto bytes = std::as_bytes(std::span(png->data(), png->size()));
  high.materials[0].base_color_image.assign(bytes.begin(), bytes.end());
  BakeOptions options;
  options.size_px = 64;
  options.maps.colors = options.maps.positions = true;
  const auto maps = baked(high, sheet(0.1f), options);
  ASSERT_TRUE(maps);
  for (std::size_t i = 0; i < maps->owner.size(); ++i) {
    const float x = maps->positions.values[3 * i];
    if (maps->owner[i] == kInvalidId || std::abs(x) < 0.05f || std::abs(x) > 0.45f) continue;
    const float expected = linear_of_srgb(x < 0 ? 55 : 188);
    ASSERT_NEAR(maps->colors.values[4 * i], expected, 2e-3f) << x;
    ASSERT_NEAR(maps->colors.values[4 * i + 1], 0.5f * expected, 2e-3f) << x;
  }
  const auto model = mesh_with_maps(*maps);
  ASSERT_TRUE(model);
  EXPECT_FALSE(model->materials.at(0).base_color_image.empty());
  EXPECT_TRUE(model->materials[0].normal_image.empty());
}

void expect_same_maps(const BakedMaps& a, const BakedMaps& b) {
  EXPECT_TRUE(test::same_bits(a.object_normals.values, b.object_normals.values));
  EXPECT_TRUE(test::same_bits(a.tangent_normals.values, b.tangent_normals.values));
  EXPECT_TRUE(test::same_bits(a.displacement.values, b.displacement.values));
  EXPECT_TRUE(test::same_bits(a.occlusion.values, b.occlusion.values));
  EXPECT_TRUE(test::same_bits(a.owner, b.owner));
  EXPECT_EQ(a.report.misses, b.report.misses);
  EXPECT_EQ(a.report.worst_distance, b.report.worst_distance);
  EXPECT_EQ(a.report.worst_x, b.report.worst_x);
}

TEST(Bake, IsTheSameForAnyNumberOfThreads) {
  BakeOptions options;
  options.size_px = 200;
  options.maps = {true, true, false, true, true, false};
  options.occlusion_rays = 8;
  const Mesh high = test::shape(Shape::kTerrain, 30000);
  Mesh low = test::shape(Shape::kTerrain, 500);
  for (Vec3& p : low.positions)
    p *= 1.05f;
  low.uvs = {};
  const auto many = baked(high, low, options);
  const ThreadLimit one(1);
  const auto single = baked(high, low, options);
  ASSERT_TRUE(many && single);
  EXPECT_GT(many->report.misses, 0u);  // the closest point is part of this test
  expect_same_maps(*many, *single);
}

void expect_numbers(const FloatImage& image, const std::string& name) {
  for (const float value : image.values)
    ASSERT_TRUE(std::isfinite(value)) << name;
}

TEST(Bake, AwkwardMeshesGiveNumbers) {
  BakeOptions options;
  options.size_px = 64;
  options.occlusion_rays = 4;
  options.maps = {true, true, true, true, true, true};
  options.layout = BakeLayout::kTiles;
  for (const test::StableMesh& awkward : test::awkward_meshes()) {
    const auto maps = bake(awkward.mesh, awkward.mesh, options);
    if (awkward.mesh.faces.empty()) {
      ASSERT_FALSE(maps);
      EXPECT_EQ(maps.error().code, ErrorCode::kUnsuitable);
      continue;
    }
    if (!maps && maps.error().code == ErrorCode::kInvalidArgument) continue;  // more faces than 64 × 64 has room for
    ASSERT_TRUE(maps) << awkward.name << ": " << format_error(maps.error());
    for (const FloatImage* image : {&maps->object_normals, &maps->tangent_normals, &maps->colors, &maps->displacement,
                                    &maps->occlusion, &maps->positions})
      expect_numbers(*image, awkward.name);
    for (std::size_t i = 0; i < maps->owner.size(); ++i) {
      ASSERT_NEAR(glm::length(vector_at(maps->object_normals, i)), 1.0f, 1e-4f) << awkward.name;
      ASSERT_NEAR(glm::length(vector_at(maps->tangent_normals, i)), 1.0f, 1e-4f) << awkward.name;
    }
  }
}

TEST(Bake, RefusesWhatItCannotDo) {
  const Mesh mesh = test::sphere(80);
  const auto code = [&](const Mesh& high, const Mesh& low, const BakeOptions& options) {
    const auto maps = bake(high, low, options);
    EXPECT_FALSE(maps);
    return maps ? ErrorCode::kCancelled : maps.error().code;
  };
  EXPECT_EQ(code({}, mesh, {}), ErrorCode::kUnsuitable);
  EXPECT_EQ(code(mesh, {}, {}), ErrorCode::kUnsuitable);
  BakeOptions tiny, crowded, odd, own, stopped;
  tiny.size_px = 2;
  EXPECT_EQ(code(mesh, mesh, tiny), ErrorCode::kInvalidArgument);
  crowded.size_px = 8;
  EXPECT_EQ(code(mesh, mesh, crowded), ErrorCode::kInvalidArgument);
  odd.samples = 3;
  EXPECT_EQ(code(mesh, mesh, odd), ErrorCode::kInvalidArgument);
  own.layout = BakeLayout::kOwnUvs;
  EXPECT_EQ(code(mesh, mesh, own), ErrorCode::kUnsuitable);
  stopped.progress = [](std::string_view, double) { return false; };
  EXPECT_EQ(code(mesh, mesh, stopped), ErrorCode::kCancelled);
  Mesh broken = mesh;
  broken.positions[broken.faces[3][1]].y = NAN;
  EXPECT_EQ(code(broken, mesh, {}), ErrorCode::kUnsuitable);
}

}  // namespace
}  // namespace limn
