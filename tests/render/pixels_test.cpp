// Which pixels a picture covers, by how much, and with what colour and alpha.
#include <cmath>

#include "limn/base/random.h"

#include "drawing_test.h"

namespace limn {
namespace {

using test::kTransparent;
using test::kWhite;
using test::picture_options;
using test::pixel_camera;
using test::rectangle;

class Pixels : public test::DrawingTest {};

/// Signed distance of p from the line through a and b, positive on the left. In double, apart from any rasterizer.
double distance_left_of(const Vec3& a, const Vec3& b, double x, double y) {
  const double dx = double{b.x} - double{a.x}, dy = double{b.y} - double{a.y};
  return (dx * (y - double{a.y}) - dy * (x - double{a.x})) / std::hypot(dx, dy);
}

/// 1 inside, -1 outside, 0 where the centre lies too near an edge for the rasterizer's 1/256 pixel grid to be held to
/// it.
int side_of(const Mesh& mesh, double x, double y) {
  const Vec3& a = mesh.positions[0];
  const Vec3& b = mesh.positions[1];
  const Vec3& c = mesh.positions[2];
  const double turn = distance_left_of(a, b, double{c.x}, double{c.y}) < 0.0 ? -1.0 : 1.0;
  const double inside = std::min(
      {turn * distance_left_of(a, b, x, y), turn * distance_left_of(b, c, x, y), turn * distance_left_of(c, a, x, y)});
  constexpr double kTooNear = 0.01;
  return std::abs(inside) < kTooNear ? 0 : inside > 0.0 ? 1 : -1;
}

TEST_F(Pixels, ATriangleCoversThePixelsWhoseCentresItHolds) {
  constexpr int kWidth = 61, kHeight = 47;
  Random random(5);
  int checked = 0, covered = 0;
  for (int round = 0; round < 40; ++round) {
    Mesh mesh;
    for (int i = 0; i < 3; ++i) {
      mesh.positions.emplace_back(random.uniform(-10.0, kWidth + 10.0), random.uniform(-10.0, kHeight + 10.0), 0.0);
    }
    mesh.faces = {{0, 1, 2}};
    const Image image = draw(mesh, pixel_camera(kWidth, kHeight), picture_options(kWidth, kHeight, 1, kTransparent));
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const int side = side_of(mesh, x + 0.5, kHeight - 1 - y + 0.5);
        if (side == 0) continue;
        ++checked;
        covered += side > 0 ? 1 : 0;
        ASSERT_EQ(image.pixel(x, y)[3], side > 0 ? 255 : 0) << "round " << round << ", pixel " << x << ", " << y;
      }
    }
  }
  EXPECT_GT(covered, 10000);
  EXPECT_GT(checked, 100000);
}

TEST_F(Pixels, FourSamplesGiveCoverageInStepsOfAQuarterNearTheTrueArea) {
  constexpr int kSize = 32;
  Mesh mesh;  // everything below a slanted line
  mesh.positions = {Vec3(-100, -100, 0), Vec3(132, -100, 0), Vec3(132, 42.4f, 0), Vec3(-100, -27.2f, 0)};
  mesh.faces = {{0, 1, 2}, {0, 2, 3}};
  const Image image = draw(mesh, pixel_camera(kSize, kSize), picture_options(kSize, kSize, 4, kTransparent));
  double covered = 0.0, area = 0.0;
  for (int x = 0; x < kSize; ++x) {
    area += 2.8 + 0.3 * (x + 0.5);
    for (int y = 0; y < kSize; ++y) {
      const double alpha = image.pixel(x, y)[3] / 255.0;
      covered += alpha;
      EXPECT_NEAR(alpha * 4.0, std::round(alpha * 4.0), 0.02);
    }
  }
  EXPECT_NEAR(covered, area, 0.02 * area);
}

TEST_F(Pixels, AlphaIsStraight) {
  constexpr int kSize = 24;
  Mesh mesh;
  mesh.positions = {Vec3(2.3f, 1.7f, 0), Vec3(21.1f, 5.9f, 0), Vec3(9.4f, 22.2f, 0)};
  mesh.faces = {{0, 1, 2}};
  const Image image = draw(mesh, pixel_camera(kSize, kSize), picture_options(kSize, kSize, 4, kTransparent));
  const std::uint8_t* const inside = image.pixel(11, 13);
  ASSERT_EQ(inside[3], 255);
  int partial = 0;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const std::uint8_t* const pixel = image.pixel(x, y);
      if (pixel[3] == 0) {
        EXPECT_EQ(int{pixel[0]} + pixel[1] + pixel[2], 0);
        continue;
      }
      partial += pixel[3] < 255 ? 1 : 0;
      // A flat face under a distant light has one colour; only its alpha may change at the rim.
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(pixel[c], inside[c], 1) << x << ", " << y;
    }
  }
  EXPECT_GT(partial, 20);
}

TEST_F(Pixels, TheBackgroundIsExactAndOpaque) {
  const Vec4 background(10.0f / 255.0f, 200.0f / 255.0f, 77.0f / 255.0f, 1.0f);
  for (const int samples : {1, 4}) {
    const Image image =
        draw(rectangle(Vec2(4, 4), Vec2(8, 8)), pixel_camera(16, 16), picture_options(16, 16, samples, background));
    EXPECT_EQ(image.pixel(0, 0)[0], 10);
    EXPECT_EQ(image.pixel(0, 0)[1], 200);
    EXPECT_EQ(image.pixel(15, 15)[2], 77);
    for (int i = 0; i < 256; ++i)
      EXPECT_EQ(image.rgba[static_cast<std::size_t>(4 * i + 3)], 255);
  }
}

TEST_F(Pixels, EdgesAgainstABackgroundMixInLinearLight) {
  Mesh mesh = rectangle(Vec2(-5, -5), Vec2(8, 8.5f));
  mesh.materials.emplace_back().base_color = Vec4(0, 0, 0, 1);
  mesh.materials[0].roughness = 1.0f;
  const Image image = draw(mesh, pixel_camera(16, 16), picture_options(16, 16, 4, kWhite));
  const int dark = image.pixel(3, 12)[1];
  const int half = image.pixel(3, 7)[1];
  // Half of white and half of nearly black is 188 in sRGB; mixed without regard for the transfer curve it would be near
  // 128 + dark / 2.
  const double linear = std::pow((dark / 255.0 + 0.055) / 1.055, 2.4);
  const double mixed = 0.5 * (1.0 + linear);
  EXPECT_NEAR(half, 255.0 * (1.055 * std::pow(mixed, 1.0 / 2.4) - 0.055), 2.0);
}

TEST_F(Pixels, APartlyTransparentBackgroundKeepsItsAlpha) {
  const Image image = draw(Mesh(), pixel_camera(4, 4), picture_options(4, 4, 4, Vec4(1, 0, 0, 0.2f)));
  EXPECT_EQ(image.pixel(2, 2)[0], 255);
  EXPECT_EQ(image.pixel(2, 2)[3], 51);
}

TEST_F(Pixels, NearerFacesHideFartherOnesInAnyOrder) {
  Mesh near_first = rectangle(Vec2(0, 0), Vec2(8, 8), 2.0f);
  test::append(near_first, rectangle(Vec2(0, 0), Vec2(8, 8), 1.0f));
  near_first.materials.resize(2);
  near_first.materials[0].base_color = Vec4(1, 0, 0, 1);
  near_first.materials[1].base_color = Vec4(0, 1, 0, 1);
  for (const bool near_is_red : {true, false}) {
    const std::uint32_t red = near_is_red ? 0 : 1;
    near_first.face_materials = {red, red, 1 - red, 1 - red};
    const Image image = draw(near_first, pixel_camera(8, 8), picture_options(8, 8, 1, kWhite));
    EXPECT_EQ(image.pixel(4, 4)[0] > image.pixel(4, 4)[1], near_is_red);
  }
}

}  // namespace
}  // namespace limn
