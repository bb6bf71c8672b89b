// Normal maps: tilted as the picture says, whatever way texture coordinates run.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "limn/base/random.h"

#include "drawing_test.h"

namespace limn {
namespace {

using test::kWhite;
using test::picture_options;
using test::pixel_camera;
using test::png_of;
using test::rectangle;

std::uint8_t stored(float value) {
  return static_cast<std::uint8_t>(std::lround(127.5f * (value + 1.0f)));
}

/// What a shader reads back of it.
Vec3 as_stored(const Vec3& n) {
  return Vec3(stored(n.x), stored(n.y), stored(n.z)) / 127.5f - 1.0f;
}

void set_pixel(Image& image, int x, int y, const Vec3& n) {
  const std::array<std::uint8_t, 4> bytes = {stored(n.x), stored(n.y), stored(n.z), 255};
  std::copy(bytes.begin(), bytes.end(), image.pixel(x, y));
}

Material with_map(const Image& map) {
  Material material;
  material.base_color = Vec4(0.6f, 0.5f, 0.4f, 1.0f);
  material.roughness = 0.4f;
  material.normal_image = png_of(map);
  material.normal_image_mime = "image/png";
  return material;
}

Material with_constant_map(const Vec3& n) {
  Image map(4, 4);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 4; ++x)
      set_pixel(map, x, y, n);
  }
  return with_map(map);
}

Material without_map(Material material) {
  material.normal_image.clear();
  return material;
}

class NormalMap : public test::DrawingTest {
 protected:
  static constexpr int kSide = 16;

  Image draw_small(const Mesh& mesh) {
    return draw(mesh, pixel_camera(kSide, kSide), picture_options(kSide, kSide, 1, kWhite));
  }

  /// A square that fills the picture, its material with the map.
  static Mesh mapped_square(const Vec3& n) {
    Mesh mesh = rectangle(Vec2(0, 0), Vec2(kSide, kSide));
    mesh.materials = {with_constant_map(n)};
    return mesh;
  }

  /// The same square without a map, its vertices' normals as given.
  static Mesh turned_square(const Mesh& mapped, const Vec3& n) {
    Mesh mesh = mapped;
    mesh.materials = {without_map(mapped.materials[0])};
    mesh.normals.values.assign(4, glm::normalize(n));
    return mesh;
  }
};

TEST_F(NormalMap, AConstantMapShadesLikeThePlaneTiltedThatWay) {
  for (const Vec3& n : {Vec3(0.5f, 0.0f, 0.866f), Vec3(-0.5f, 0.0f, 0.866f), Vec3(0.0f, 0.6f, 0.8f),
                        Vec3(0.0f, -0.6f, 0.8f), Vec3(0.4f, -0.3f, 0.866f)}) {
    const Mesh mapped = mapped_square(n);
    const Image seen = draw_small(mapped);
    EXPECT_EQ(compare_images(seen, draw_small(turned_square(mapped, as_stored(n))), 1).failing_share, 0.0);
    // And like a plane that really lies so: z chosen for every vertex to be perpendicular to n.
    Mesh tilted = mapped;
    tilted.materials = {without_map(mapped.materials[0])};
    for (Vec3& p : tilted.positions)
      p.z = -(n.x * (p.x - 8.0f) + n.y * (p.y - 8.0f)) / n.z;
    Camera camera = pixel_camera(kSide, kSide);
    camera.eye.z = 40.0f;
    camera.far_distance = 80.0f;
    const Image really = draw(tilted, camera, picture_options(kSide, kSide, 1, kWhite));
    EXPECT_EQ(compare_images(seen, really, 2).failing_share, 0.0);
    EXPECT_GT(compare_images(seen, draw_small(turned_square(mapped, Vec3(0, 0, 1))), 8).failing_share, 0.9);
  }
}

TEST_F(NormalMap, TheScaleStretchesTheTilt) {
  Mesh mesh = mapped_square(Vec3(0.6f, 0.0f, 0.8f));
  mesh.materials[0].normal_scale = 0.5f;
  const Vec3 n = as_stored(Vec3(0.6f, 0.0f, 0.8f)) * Vec3(0.5f, 0.5f, 1.0f);
  EXPECT_EQ(compare_images(draw_small(mesh), draw_small(turned_square(mesh, n)), 1).failing_share, 0.0);
}

/// The frame of MikkTSpace on a flat triangle that faces +z: where u grows, and the side to which v grows.
std::array<Vec3, 2> frame_of(const Vec2& u_gradient, const Vec2& v_gradient) {
  const float turn = u_gradient.x * v_gradient.y - u_gradient.y * v_gradient.x;
  const float side = turn < 0.0f ? -1.0f : 1.0f;
  const Vec3 tangent = glm::normalize(side * Vec3(v_gradient.y, -v_gradient.x, 0.0f));
  return {tangent, side * glm::cross(Vec3(0, 0, 1), tangent)};
}

TEST_F(NormalMap, FollowsTextureCoordinatesHoweverTheyAreTurnedShearedAndMirrored) {
  Random random(11);
  const Vec3 n(0.48f, 0.36f, 0.8f);
  int mirrored = 0;
  for (int round = 0; round < 40; ++round) {
    Vec2 u, v;
    do {
      u = Vec2(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
      v = Vec2(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
    } while (std::abs(u.x * v.y - u.y * v.x) < 0.1f);
    mirrored += u.x * v.y - u.y * v.x < 0.0f ? 1 : 0;
    Mesh mesh = mapped_square(n);
    for (std::size_t i = 0; i < 4; ++i) {
      const Vec2 p(mesh.positions[i]);
      mesh.uvs.values[i] = 0.1f * Vec2(glm::dot(u, p), glm::dot(v, p));
    }
    const auto [tangent, bitangent] = frame_of(u, v);
    const Vec3 s = as_stored(n);
    const Vec3 expected = s.x * tangent + s.y * bitangent + s.z * Vec3(0, 0, 1);
    EXPECT_EQ(compare_images(draw_small(mesh), draw_small(turned_square(mesh, expected)), 2).failing_share, 0.0)
        << "round " << round;
  }
  EXPECT_GT(mirrored, 10);
  EXPECT_LT(mirrored, 30);
}

TEST_F(NormalMap, TheFrameLiesAboutTheShadingNormalNotTheFace) {
  Mesh mesh = mapped_square(Vec3(0.0f, 0.6f, 0.8f));
  const Vec3 shading = glm::normalize(Vec3(0.5f, 0.0f, 0.8f));
  mesh.normals.values.assign(4, shading);
  const Vec3 s = as_stored(Vec3(0.0f, 0.6f, 0.8f));
  const Vec3 tangent = glm::normalize(Vec3(1, 0, 0) - shading * shading.x);
  const Vec3 expected = s.x * tangent + s.y * glm::cross(shading, tangent) + s.z * shading;
  EXPECT_EQ(compare_images(draw_small(mesh), draw_small(turned_square(mesh, expected)), 1).failing_share, 0.0);
}

TEST_F(NormalMap, SeenFromBehindABumpIsADent) {
  for (const bool with_normals : {false, true}) {
    Mesh mesh = mapped_square(Vec3(0.6f, 0.0f, 0.8f));
    if (with_normals) mesh.normals.values.assign(4, Vec3(0, 0, 1));
    Camera behind = pixel_camera(kSide, kSide);
    behind.eye.z = -10.0f;
    const RenderOptions options = picture_options(kSide, kSide, 1, kWhite);
    const Mesh turned = turned_square(mesh, as_stored(Vec3(0.6f, 0.0f, 0.8f)));
    EXPECT_EQ(compare_images(draw(mesh, behind, options), draw(turned, behind, options), 1).failing_share, 0.0);
  }
}

TEST_F(NormalMap, WithoutUsableTextureCoordinatesTheNormalStays) {
  const Mesh mesh = mapped_square(Vec3(0.6f, 0.0f, 0.8f));
  const Image unmapped = draw_small(turned_square(mesh, Vec3(0, 0, 1)));
  const std::array<std::array<Vec2, 4>, 4> cases = {{
      {Vec2(0.3f), Vec2(0.3f), Vec2(0.3f), Vec2(0.3f)},
      {Vec2(0, 0.5f), Vec2(1, 0.5f), Vec2(1, 0.5f), Vec2(0, 0.5f)},
      {Vec2(0, 0), Vec2(1, 1), Vec2(2, 2), Vec2(1, 1)},
      {Vec2(-3e38f, 0), Vec2(3e38f, 0), Vec2(3e38f, 1), Vec2(-3e38f, 1)},
  }};
  for (const auto& uvs : cases) {
    Mesh broken = mesh;
    broken.uvs.values.assign(uvs.begin(), uvs.end());
    EXPECT_EQ(compare_images(draw_small(broken), unmapped, 1).failing_share, 0.0);
  }
  Mesh bare = mesh;
  bare.uvs = {};
  EXPECT_EQ(compare_images(draw_small(bare), unmapped, 1).failing_share, 0.0);
}

/// A round hill, symmetric left to right; the right half alone when asked.
Image hill(int size, bool right_half) {
  Image map(right_half ? size / 2 : size, size);
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < map.width; ++x) {
      const float at_x = (static_cast<float>(right_half ? x + size / 2 : x) + 0.5f) / static_cast<float>(size) - 0.5f;
      const float at_y = 0.5f - (static_cast<float>(y) + 0.5f) / static_cast<float>(size);
      const float away = std::sqrt(at_x * at_x + at_y * at_y);
      const float slope = away < 0.4f ? 2.0f * std::sin(7.85f * away) : 0.0f;
      set_pixel(map, x, y, glm::normalize(Vec3(slope * at_x / (away + 1e-6f), slope * at_y / (away + 1e-6f), 1.0f)));
    }
  }
  return map;
}

TEST_F(NormalMap, HalvesThatMirrorOneMapShowNoSeam) {
  constexpr int kSize = 64;
  Mesh whole = rectangle(Vec2(0, 0), Vec2(kSize, kSize));
  whole.materials = {with_map(hill(kSize, false))};
  Mesh halves = rectangle(Vec2(kSize / 2, 0), Vec2(kSize, kSize));
  Mesh left = rectangle(Vec2(0, 0), Vec2(kSize / 2, kSize));
  for (Vec2& uv : left.uvs.values)
    uv.x = 1.0f - uv.x;
  test::append(halves, left);
  halves.materials = {with_map(hill(kSize, true))};
  const RenderOptions options = picture_options(kSize, kSize, 1, kWhite);
  const Image expected = draw(whole, pixel_camera(kSize, kSize), options);
  const Image seen = draw(halves, pixel_camera(kSize, kSize), options);
  EXPECT_EQ(compare_images(seen, expected, 4).failing_share, 0.0);
  // The light comes from the left above: a hill is lit there, a dent is not.
  EXPECT_GT(expected.pixel(22, 22)[1], expected.pixel(42, 42)[1] + 40);
}

TEST_F(NormalMap, ABrokenPictureNamesItsMaterial) {
  Mesh mesh = mapped_square(Vec3(0, 0, 1));
  mesh.materials[0].name = "bark";
  mesh.materials[0].normal_image.assign(40, std::byte{7});
  const auto image = render(*context_, mesh, pixel_camera(16, 16), picture_options(16, 16, 1, kWhite));
  ASSERT_FALSE(image);
  EXPECT_EQ(image.error().code, ErrorCode::kUnsuitable);
  const std::string message = format_error(image.error());
  EXPECT_NE(message.find("bark"), std::string::npos) << message;
  EXPECT_NE(message.find("normal picture"), std::string::npos) << message;
}

}  // namespace
}  // namespace limn
