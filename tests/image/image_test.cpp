#include "limn/image/image.h"

#include <gtest/gtest.h>

namespace limn {
namespace {

Image filled(int width, int height, std::uint8_t value) {
  Image image(width, height);
  for (std::uint8_t& channel : image.rgba)
    channel = value;
  return image;
}

TEST(SideBySide, AlignsTopsAndLeavesTheGapTransparent) {
  const Image joined = side_by_side({filled(2, 3, 10), filled(1, 1, 20)}, 2);
  ASSERT_EQ(joined.width, 5);
  ASSERT_EQ(joined.height, 3);
  EXPECT_EQ(joined.pixel(1, 2)[0], 10);
  EXPECT_EQ(joined.pixel(2, 0)[3], 0);
  EXPECT_EQ(joined.pixel(3, 0)[3], 0);
  EXPECT_EQ(joined.pixel(4, 0)[0], 20);
  EXPECT_EQ(joined.pixel(4, 1)[3], 0);
}

TEST(SideBySide, OfNothingIsEmpty) {
  EXPECT_EQ(side_by_side({}).width, 0);
  EXPECT_EQ(side_by_side({filled(4, 4, 1)}, 9).width, 4);
}

TEST(CompareImages, CountsPixelsBeyondTheToleranceOnly) {
  const Image expected = filled(4, 2, 100);
  Image actual = expected;
  actual.pixel(0, 0)[1] = 104;
  actual.pixel(3, 1)[2] = 95;
  const ImageDifference difference = compare_images(actual, expected, 4);
  EXPECT_DOUBLE_EQ(difference.failing_share, 1.0 / 8.0);
  EXPECT_EQ(difference.largest, 5);
  EXPECT_EQ(difference.picture.pixel(3, 1)[0], 255);
  EXPECT_EQ(difference.picture.pixel(3, 1)[1], 0);
  EXPECT_NE(difference.picture.pixel(0, 0)[1], 0);
}

TEST(CompareImages, SeesADifferenceInAlphaAlone) {
  const Image expected = filled(1, 1, 0);
  Image actual = expected;
  actual.pixel(0, 0)[3] = 255;
  EXPECT_EQ(compare_images(actual, expected, 3).failing_share, 1.0);
}

TEST(CompareImages, PicturesOfDifferentSizesFailEverywhere) {
  const ImageDifference difference = compare_images(filled(2, 2, 5), filled(2, 3, 5), 255);
  EXPECT_EQ(difference.failing_share, 1.0);
  EXPECT_EQ(difference.picture.height, 3);
}

}  // namespace
}  // namespace limn
