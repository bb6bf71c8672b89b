#include "limn/image/deep_image.h"

#include <algorithm>
#include <cmath>

#include "limn/base/parallel.h"
#include "limn/image/srgb.h"

namespace limn {
namespace {

constexpr std::size_t kPixelsATask = 16384;

/// A value as a whole number of `steps`, halves up.
std::uint32_t coded(float value, int channel, const ChannelCoding& coding, float steps) {
  const float span = coding.high - coding.low;
  float share = span > 0.0f ? (value - coding.low) / span : 0.0f;
  if (coding.srgb && channel < 3) share = srgb_of_linear(share);
  if (!(share > 0.0f)) return 0;
  return static_cast<std::uint32_t>(std::floor(static_cast<double>(std::min(share, 1.0f)) * steps + 0.5));
}

}  // namespace

Image to_8_bit(const FloatImage& image, const ChannelCoding& coding) {
  Image result(image.width, image.height);
  const auto channels = static_cast<std::size_t>(image.channels);
  parallel_for(result.rgba.size() / 4, kPixelsATask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const float* const from = image.values.data() + i * channels;
      for (std::size_t c = 0; c < 4; ++c) {
        const std::size_t source = channels == 1 && c < 3 ? 0 : c;
        std::uint8_t value = c == 3 ? 255 : 0;
        if (source < channels) value = static_cast<std::uint8_t>(coded(from[source], int(c), coding, 255.0f));
        result.rgba[4 * i + c] = value;
      }
    }
  });
  return result;
}

DeepImage to_16_bit(const FloatImage& image, const ChannelCoding& coding) {
  DeepImage result{image.width, image.height, image.channels, {}};
  result.values.resize(image.values.size());
  const auto channels = static_cast<std::size_t>(image.channels);
  parallel_for(result.values.size(), kPixelsATask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const int channel = static_cast<int>(i % channels);
      result.values[i] = static_cast<std::uint16_t>(coded(image.values[i], channel, coding, 65535.0f));
    }
  });
  return result;
}

ChannelCoding range_of(const FloatImage& image, int channel) {
  ChannelCoding range{0.0f, 0.0f, false};
  bool any = false;
  for (std::size_t i = static_cast<std::size_t>(channel); i < image.values.size();
       i += static_cast<std::size_t>(image.channels)) {
    const float value = image.values[i];
    if (!std::isfinite(value)) continue;
    range.low = any ? std::min(range.low, value) : value;
    range.high = any ? std::max(range.high, value) : value;
    any = true;
  }
  return range;
}

}  // namespace limn
