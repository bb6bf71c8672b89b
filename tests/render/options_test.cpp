// What render() refuses, and what it does with nothing to draw.
#include <cmath>
#include <limits>

#include "limn/render/targets.h"

#include "drawing_test.h"

namespace limn {
namespace {

using test::kWhite;
using test::picture_options;
using test::pixel_camera;

class Options : public test::DrawingTest {
 protected:
  ErrorCode refusal(const RenderOptions& options) {
    const auto image = render(*context_, test::rectangle(Vec2(0, 0), Vec2(4, 4)), pixel_camera(8, 8), options);
    EXPECT_FALSE(image);
    return image ? ErrorCode::kCancelled : image.error().code;
  }
};

TEST_F(Options, SizesOutsideTheRangeAreRefused) {
  for (const auto& [width, height] : {std::pair{0, 8}, {8, 0}, {-1, 8}, {16385, 1}, {1, 1 << 30}}) {
    EXPECT_EQ(refusal(picture_options(width, height, 1, kWhite)), ErrorCode::kInvalidArgument)
        << width << " x " << height;
  }
}

TEST_F(Options, OtherSampleCountsWidthsAndColoursAreRefused) {
  for (const int samples : {0, 2, 3, 8, -1}) {
    EXPECT_EQ(refusal(picture_options(8, 8, samples, kWhite)), ErrorCode::kInvalidArgument);
  }
  RenderOptions options = picture_options(8, 8, 1, kWhite);
  for (const float width : {0.0f, -1.0f, std::nanf(""), std::numeric_limits<float>::infinity()}) {
    options.line_width_px = width;
    EXPECT_EQ(refusal(options), ErrorCode::kInvalidArgument);
  }
  EXPECT_EQ(refusal(picture_options(8, 8, 1, Vec4(2, 0, 0, 1))), ErrorCode::kInvalidArgument);
  EXPECT_EQ(refusal(picture_options(8, 8, 1, Vec4(0, 0, 0, std::nanf("")))), ErrorCode::kInvalidArgument);
}

TEST_F(Options, NarrowPicturesOfExtremeShapeAreDrawn) {
  const Image wide =
      draw(test::rectangle(Vec2(0, 0), Vec2(9000, 1)), pixel_camera(9000, 1), picture_options(9000, 1, 4, kWhite));
  EXPECT_LT(wide.pixel(8999, 0)[1], 250);
  const Image one = draw(test::rectangle(Vec2(0, 0), Vec2(1, 1)), pixel_camera(1, 1), picture_options(1, 1, 1, kWhite));
  EXPECT_LT(one.pixel(0, 0)[1], 250);
}

TEST_F(Options, AnEmptyMeshGivesTheBackground) {
  RenderOptions options = picture_options(5, 3, 4, kWhite);
  options.wireframe = true;
  const Image image = draw(Mesh(), pixel_camera(5, 3), options);
  ASSERT_EQ(image.rgba.size(), 60u);
  for (const std::uint8_t channel : image.rgba)
    EXPECT_EQ(channel, 255);
}

TEST(Targets, APictureTheDeviceCannotHoldIsRefusedWithAdvice) {
  const auto context = gl::Context::create();
  ASSERT_TRUE(context);
  const auto targets = RenderTargets::create(1 << 28, 1 << 28, 4);
  ASSERT_FALSE(targets);
  EXPECT_EQ(targets.error().code, ErrorCode::kNoGraphics);
  EXPECT_NE(targets.error().remedy.find("1 sample"), std::string::npos);
  // The largest size there is either fits or is refused in the same way, and the next picture is drawn as ever.
  const auto largest = RenderTargets::create(16384, 16384, 4);
  if (!largest) {
    EXPECT_EQ(largest.error().code, ErrorCode::kNoGraphics);
  }
  EXPECT_TRUE(RenderTargets::create(16, 16, 4));
}

TEST(LevelColor, RunsFromBlueThroughGreenToYellow) {
  EXPECT_GT(level_color(0, 3).z, level_color(0, 3).x);
  EXPECT_GT(level_color(1.5f, 3).y, level_color(1.5f, 3).z);
  EXPECT_GT(level_color(3, 3).x, 0.9f);
  EXPECT_EQ(level_color(7, 3), level_color(3, 3));
  EXPECT_EQ(level_color(1, 0), level_color(0, 3));
}

}  // namespace
}  // namespace limn
