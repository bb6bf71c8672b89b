// Segments and wireframes: width, rim, what hides them.
#include <cmath>

#include "drawing_test.h"

namespace limn {
namespace {

using test::kTransparent;
using test::kWhite;
using test::picture_options;
using test::pixel_camera;
using test::rectangle;

constexpr Vec3 kBlack(0, 0, 0);

class Lines : public test::DrawingTest {
 protected:
  Image draw_line(const Segment3& segment, float width_px, int samples, const Mesh& mesh = {}) {
    RenderOptions options = picture_options(32, 32, samples, kTransparent);
    options.line_width_px = width_px;
    options.draw_faces = false;
    return draw(mesh, pixel_camera(32, 32), options, {&segment, 1});
  }
};

double column_alpha(const Image& image, int x) {
  double sum = 0.0;
  for (int y = 0; y < image.height; ++y)
    sum += image.pixel(x, y)[3] / 255.0;
  return sum;
}

TEST_F(Lines, AreAsWideAsAskedWhereverTheyLie) {
  for (const int samples : {1, 4}) {
    for (const float width : {1.0f, 1.5f, 3.0f}) {
      for (const float y : {15.5f, 16.0f, 16.2f}) {
        const Image image = draw_line({Vec3(-5, y, 0), Vec3(40, y, 0), kBlack}, width, samples);
        for (const int x : {0, 13, 31})
          EXPECT_NEAR(column_alpha(image, x), width, 0.02) << width << " at " << y;
      }
    }
  }
}

TEST_F(Lines, SlantedOnesCoverLengthTimesWidth) {
  const Image image = draw_line({Vec3(6, 7, 0), Vec3(25, 22, 0), kBlack}, 2.0f, 1);
  double sum = 0.0;
  for (int x = 0; x < 32; ++x)
    sum += column_alpha(image, x);
  const double length = std::hypot(19.0, 15.0);
  const double round_ends = 3.14159 * 1.0;
  EXPECT_NEAR(sum, length * 2.0 + round_ends, 0.03 * length * 2.0);
}

TEST_F(Lines, KeepTheirWidthInPerspective) {
  Camera camera;  // at z = 3, looking at the origin
  camera.near_distance = 0.1f;
  RenderOptions options = picture_options(64, 64, 1, kTransparent);
  options.line_width_px = 2.0f;
  const Segment3 receding{Vec3(-0.4f, 0, 1), Vec3(0.9f, 0, -4), kBlack};
  const Image image = draw(Mesh(), camera, options, {&receding, 1});
  for (const int x : {20, 32, 36})
    EXPECT_NEAR(column_alpha(image, x), 2.0, 0.02);
}

TEST_F(Lines, HaveTheColourAskedFor) {
  const Vec3 orange(200.0f / 255.0f, 100.0f / 255.0f, 50.0f / 255.0f);
  const Image image = draw_line({Vec3(0, 16, 0), Vec3(32, 16, 0), orange}, 6.0f, 4);
  EXPECT_NEAR(image.pixel(16, 16)[0], 200, 1);
  EXPECT_NEAR(image.pixel(16, 16)[1], 100, 1);
  EXPECT_NEAR(image.pixel(16, 16)[2], 50, 1);
}

TEST_F(Lines, AreHiddenBehindFacesEvenFacesWithoutColour) {
  const Mesh left_half = rectangle(Vec2(-5, -5), Vec2(16, 40), 1.0f);
  for (const int samples : {1, 4}) {
    const Image image = draw_line({Vec3(0, 16, 0), Vec3(32, 16, 0), kBlack}, 2.0f, samples, left_half);
    EXPECT_EQ(column_alpha(image, 4), 0.0);
    EXPECT_EQ(column_alpha(image, 13), 0.0);
    EXPECT_NEAR(column_alpha(image, 25), 2.0, 0.02);
  }
}

TEST_F(Lines, OnASurfaceAreSeenHoweverSteepItIs) {
  for (const float steepness : {0.0f, 1.0f, 8.0f}) {
    Mesh mesh;  // a roof whose ridge the line runs along
    const auto at = [&](float x, float y) { return Vec3(x, y, -0.1f * steepness * std::abs(x - 16.0f)); };
    mesh.positions = {at(8, -5), at(16, -5), at(16, 40), at(8, 40), at(24, -5), at(24, 40)};
    mesh.faces = {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}};
    const Image image = draw_line({Vec3(16, -5, 0), Vec3(16, 40, 0), kBlack}, 3.0f, 4, mesh);
    double row = 0.0;
    for (int x = 0; x < 32; ++x)
      row += image.pixel(x, 12)[3] / 255.0;
    EXPECT_NEAR(row, 3.0, 0.03) << steepness;
  }
}

TEST_F(Lines, OnTheRimOfAFaceShowTheirFullWidth) {
  const Mesh face = rectangle(Vec2(-5, -5), Vec2(16, 40), 0.0f);
  const Image image = draw_line({Vec3(16, -5, 0), Vec3(16, 40, 0), kBlack}, 4.0f, 4, face);
  for (int x = 14; x < 18; ++x)
    EXPECT_EQ(image.pixel(x, 9)[3], 255) << x;
}

TEST_F(Lines, ThatPassTheEyeAreCutAtTheNearPlane) {
  Camera camera;
  camera.near_distance = 0.5f;
  RenderOptions options = picture_options(64, 64, 1, kTransparent);
  options.line_width_px = 2.0f;
  const Segment3 segments[] = {{Vec3(0, 0, -3), Vec3(0.4f, 0, 8), kBlack}, {Vec3(0, 1, 5), Vec3(1, 1, 4), kBlack}};
  const Image image = draw(Mesh(), camera, options, segments);
  EXPECT_NEAR(column_alpha(image, 40), 2.0, 0.02);
  EXPECT_EQ(column_alpha(image, 20), 0.0);  // neither the far side of the first nor the second appears mirrored
}

class Wireframe : public test::DrawingTest {
 protected:
  Image draw_wires(const Mesh& mesh, bool draw_faces, int samples = 1) {
    RenderOptions options = picture_options(32, 32, samples, kTransparent);
    options.wireframe = true;
    options.draw_faces = draw_faces;
    return draw(mesh, pixel_camera(32, 32), options);
  }
};

TEST_F(Wireframe, DrawsBordersAndDiagonalsDarkOverLitFaces) {
  const Image image = draw_wires(rectangle(Vec2(2, 2), Vec2(30, 30)), true);
  const int face = image.pixel(22, 24)[1];
  EXPECT_GT(face, 90);
  EXPECT_LT(image.pixel(16, 15)[1], 0.7 * face);  // the diagonal runs from bottom left to top right
  EXPECT_LT(image.pixel(2, 16)[1], face);
  EXPECT_EQ(image.pixel(22, 24)[3], 255);
}

TEST_F(Wireframe, AloneHasTheWidthOfAPixelAndHidesWhatLiesBehind) {
  Mesh mesh = rectangle(Vec2(-40, -40), Vec2(80, 72), 1.0f);  // in front; its diagonal enters the picture near column 3
  const Image front = draw_wires(mesh, false);
  double sum = 0.0;
  for (int x = 8; x < 32; ++x) {
    sum += column_alpha(front, x) / 24.0;
  }
  EXPECT_NEAR(sum, 1.0 / std::cos(std::atan(112.0 / 120.0)), 0.05);
  Mesh hidden = rectangle(Vec2(3, 20), Vec2(12, 29), 0.0f);
  test::append(mesh, hidden);
  EXPECT_EQ(draw_wires(mesh, false).rgba, front.rgba);
}

TEST_F(Wireframe, FadesWhereTrianglesAreSmallerThanPixels) {
  Mesh mesh;
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x)
      test::append(mesh, rectangle(Vec2(x, y), Vec2(x + 1, y + 1)));
  }
  const Image plain = draw(mesh, pixel_camera(32, 32), picture_options(32, 32, 1, kWhite));
  RenderOptions options = picture_options(32, 32, 1, kWhite);
  options.wireframe = true;
  const Image wires = draw(mesh, pixel_camera(32, 32), options);
  EXPECT_GT(wires.pixel(16, 16)[1], 0.9 * plain.pixel(16, 16)[1]);
}

}  // namespace
}  // namespace limn
