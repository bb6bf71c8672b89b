#include "limn/image/image.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>

namespace limn {
namespace {

int channel_distance(const std::uint8_t* a, const std::uint8_t* b) {
  int largest = 0;
  for (int c = 0; c < 4; ++c)
    largest = std::max(largest, std::abs(int{a[c]} - int{b[c]}));
  return largest;
}

/// The expected pixel over white, faded so that red stands out against it.
void write_faded(const std::uint8_t* from, std::uint8_t* to) {
  const int alpha = from[3];
  for (int c = 0; c < 3; ++c) {
    const int over_white = (from[c] * alpha + 255 * (255 - alpha)) / 255;
    to[c] = static_cast<std::uint8_t>(192 + over_white / 4);
  }
  to[3] = 255;
}

}  // namespace

Image side_by_side(const std::vector<Image>& images, int gap) {
  int width = 0;
  int height = 0;
  for (const Image& image : images) {
    width += image.width + (width > 0 ? gap : 0);
    height = std::max(height, image.height);
  }
  Image result(width, height);
  int left = 0;
  for (const Image& image : images) {
    for (int y = 0; y < image.height && image.width > 0; ++y) {
      std::memcpy(result.pixel(left, y), image.pixel(0, y), 4u * static_cast<std::size_t>(image.width));
    }
    left += image.width + gap;
  }
  return result;
}

ImageDifference compare_images(const Image& actual, const Image& expected, int tolerance) {
  ImageDifference difference;
  difference.picture = Image(expected.width, expected.height);
  const bool same_size = actual.width == expected.width && actual.height == expected.height;
  std::size_t failing = 0;
  for (int y = 0; y < expected.height; ++y) {
    for (int x = 0; x < expected.width; ++x) {
      const int distance = same_size ? channel_distance(actual.pixel(x, y), expected.pixel(x, y)) : 255;
      difference.largest = std::max(difference.largest, distance);
      std::uint8_t* const out = difference.picture.pixel(x, y);
      write_faded(expected.pixel(x, y), out);
      if (distance <= tolerance) continue;
      ++failing;
      out[0] = 255;
      out[1] = out[2] = 0;
    }
  }
  const std::size_t pixels = expected.rgba.size() / 4;
  if (pixels > 0) difference.failing_share = static_cast<double>(failing) / static_cast<double>(pixels);
  if (!same_size) {
    difference.failing_share = 1.0;
    difference.largest = 255;
  }
  return difference;
}

}  // namespace limn
