#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "limn/base/result.h"
#include "limn/image/image.h"

namespace limn {

/// A picture of any number of float channels, rows from the top: what maps are computed in.
struct FloatImage {
  int width = 0;
  int height = 0;
  int channels = 0;
  std::vector<float> values;  ///< channels · width · height

  FloatImage() = default;
  FloatImage(int w, int h, int c)
      : width(w),
        height(h),
        channels(c),
        values(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * static_cast<std::size_t>(c)) {}
  bool empty() const { return values.empty(); }
  float* pixel(int x, int y) { return values.data() + offset(x, y); }
  const float* pixel(int x, int y) const { return values.data() + offset(x, y); }

 private:
  std::size_t offset(int x, int y) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) *
           static_cast<std::size_t>(channels);
  }
};

/// A picture of 1 to 4 channels of 16 bits, rows from the top.
struct DeepImage {
  int width = 0;
  int height = 0;
  int channels = 0;
  std::vector<std::uint16_t> values;  ///< channels · width · height

  bool empty() const { return values.empty(); }
};

/// How a value becomes a share of a channel's range. What lies outside is clamped; NaN becomes the low end.
struct ChannelCoding {
  float low = 0.0f;   ///< becomes 0
  float high = 1.0f;  ///< becomes the largest stored value
  bool srgb = false;  ///< the first three channels are linear light and are stored as sRGB; for low 0, high 1
};
/// Plain shares, colours in linear light, and components of unit vectors (−1 … 1, as glTF decodes normal maps).
inline constexpr ChannelCoding kShareCoding{0.0f, 1.0f, false};
inline constexpr ChannelCoding kColorCoding{0.0f, 1.0f, true};
inline constexpr ChannelCoding kVectorCoding{-1.0f, 1.0f, false};

/// Rounds to the nearest stored value, halves up; no dithering, so that equal values stay equal. One channel becomes
/// grey, two or three get alpha 1; of more than four the first four are kept. Same bits for any number of threads.
Image to_8_bit(const FloatImage& image, const ChannelCoding& coding);
/// As above with 65535 steps; channels stay as many as they are. \pre at most 4 channels
DeepImage to_16_bit(const FloatImage& image, const ChannelCoding& coding);

/// The smallest and largest finite value of a channel; low = high = 0 where there is none.
ChannelCoding range_of(const FloatImage& image, int channel);

/// The bytes of a PNG: 8 bits, without alpha where every pixel is opaque. Same pixels, same bytes.
/// Errors: kUnwritable for a picture without pixels or beyond what a PNG encoder holds.
Result<std::string> encode_png(const Image& image);
/// The bytes of a PNG of 16 bits a channel: grey, grey and alpha, RGB or RGBA.
Result<std::string> encode_png(const DeepImage& image);

/// The bytes of an OpenEXR file: 32-bit float scan lines, ZIP compression (blocks of 16 lines), channels named after
/// their number: Y; Y A; R G B; R G B A. Bits of floats are kept, NaN included. \pre 1 to 4 channels
Result<std::string> encode_exr(const FloatImage& image);

}  // namespace limn
