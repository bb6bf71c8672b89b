#include "limn/image/resample.h"

#include <cmath>
#include <gtest/gtest.h>

#include "limn/base/random.h"

namespace limn {
namespace {

Image random_picture(int width, int height) {
  Random random(3);
  Image image(width, height);
  for (std::uint8_t& channel : image.rgba)
    channel = static_cast<std::uint8_t>(random.below(256));
  return image;
}

Image plain(int width, int height, std::uint8_t value) {
  Image image(width, height);
  for (std::uint8_t& channel : image.rgba)
    channel = value;
  return image;
}

TEST(Resample, TheSameSizeKeepsItsBits) {
  const Image image = random_picture(7, 5);
  EXPECT_EQ(resample(image, 7, 5, Channels::kSrgb).rgba, image.rgba);
}

TEST(Resample, APlainPictureStaysPlainAtAnySize) {
  for (const Channels channels : {Channels::kSrgb, Channels::kLinear}) {
    for (int value = 0; value < 256; value += 15) {
      const Image image = plain(6, 4, static_cast<std::uint8_t>(value));
      for (const int side : {1, 3, 4, 5, 17}) {
        const Image other = resample(image, side, 2 * side, channels);
        ASSERT_EQ(other.width, side);
        ASSERT_EQ(other.height, 2 * side);
        for (std::size_t i = 0; i < other.rgba.size(); ++i)
          ASSERT_EQ(other.rgba[i], i % 4 == 3 ? 255 : value);
      }
    }
  }
}

TEST(Resample, ColoursAreAveragedInLinearLightAndOtherValuesAsStored) {
  Image stripes(8, 8);
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 8; ++x)
      for (int c = 0; c < 4; ++c)
        stripes.pixel(x, y)[c] = x % 2 == 0 ? 0 : 255;
  }
  EXPECT_NEAR(resample(stripes, 4, 4, Channels::kLinear).pixel(1, 2)[0], 128, 1);
  EXPECT_NEAR(resample(stripes, 4, 4, Channels::kSrgb).pixel(1, 2)[0], 188, 1);
}

TEST(Resample, GrowingInterpolatesAndWrapsAround) {
  Image two(2, 1);
  two.pixel(1, 0)[0] = 200;
  const Image grown = resample(two, 8, 1, Channels::kLinear);
  // Centres of the result lie at (i + 1/2) / 4 - 1/2 of the picture's pixels; beyond either end the other one follows.
  const int expected[] = {75, 25, 25, 75, 125, 175, 175, 125};
  for (int x = 0; x < 8; ++x)
    EXPECT_NEAR(grown.pixel(x, 0)[0], expected[x], 1) << x;
}

TEST(Resample, ShrinkingKeepsTheMeanAndLosesNoPixel) {
  const Image image = random_picture(24, 36);
  const Image small = resample(image, 8, 12, Channels::kLinear);
  double before = 0.0, after = 0.0;
  for (int y = 0; y < 36; ++y)
    for (int x = 0; x < 24; ++x)
      before += image.pixel(x, y)[1];
  for (int y = 0; y < 12; ++y)
    for (int x = 0; x < 8; ++x)
      after += small.pixel(x, y)[1];
  EXPECT_NEAR(before / (24 * 36), after / (8 * 12), 0.5);
}

}  // namespace
}  // namespace limn
