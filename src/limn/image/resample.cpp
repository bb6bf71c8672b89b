#include "limn/image/resample.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "limn/base/parallel.h"
#include "limn/base/vec.h"

namespace limn {
namespace {

constexpr std::size_t kRowsATask = 16;

/// What a pixel of the result takes from a row or column of the picture: `weights` of those from `first` on, round the
/// end to the start.
struct Taps {
  int first = 0;
  std::vector<float> weights;
};

std::vector<Taps> make_taps(int from, int to) {
  const double scale = double(from) / double(to);
  const double reach = std::max(scale, 1.0);
  std::vector<Taps> all(static_cast<std::size_t>(to));
  for (int i = 0; i < to; ++i) {
    const double middle = (i + 0.5) * scale - 0.5;
    Taps& taps = all[static_cast<std::size_t>(i)];
    taps.first = static_cast<int>(std::ceil(middle - reach));
    const int last = static_cast<int>(std::floor(middle + reach));
    double sum = 0.0;
    for (int k = taps.first; k <= last; ++k)
      sum += 1.0 - std::abs(k - middle) / reach;
    for (int k = taps.first; k <= last; ++k)
      taps.weights.push_back(static_cast<float>((1.0 - std::abs(k - middle) / reach) / sum));
  }
  return all;
}

int wrapped(int index, int size) {
  const int rest = index % size;
  return rest < 0 ? rest + size : rest;
}

/// Stored values to those that may be averaged (0 … 1), and back.
class Transfer {
 public:
  explicit Transfer(Channels channels) : srgb_(channels == Channels::kSrgb) {
    for (std::size_t i = 0; i < decoded_.size(); ++i) {
      const float value = static_cast<float>(i) / 255.0f;
      decoded_[i] = !srgb_ ? value : value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
    }
  }

  Vec3 decode(const std::uint8_t* pixel) const { return {decoded_[pixel[0]], decoded_[pixel[1]], decoded_[pixel[2]]}; }

  std::uint8_t encode(float value) const {
    if (srgb_) value = value <= 0.0031308f ? 12.92f * value : 1.055f * std::pow(value, 1.0f / 2.4f) - 0.055f;
    return static_cast<std::uint8_t>(std::clamp(std::lround(255.0f * value), 0l, 255l));
  }

 private:
  bool srgb_;
  std::array<float, 256> decoded_{};
};

Vec3 average(const Image& image, const Taps& across, const Taps& down, const Transfer& transfer) {
  Vec3 sum(0.0f);
  int y = wrapped(down.first, image.height);
  for (const float weight_y : down.weights) {
    Vec3 row(0.0f);
    int x = wrapped(across.first, image.width);
    for (const float weight_x : across.weights) {
      row += weight_x * transfer.decode(image.pixel(x, y));
      x = x + 1 == image.width ? 0 : x + 1;
    }
    sum += weight_y * row;
    y = y + 1 == image.height ? 0 : y + 1;
  }
  return sum;
}

}  // namespace

Image resample(const Image& image, int width, int height, Channels channels) {
  if (image.width == width && image.height == height) return image;
  const std::vector<Taps> across = make_taps(image.width, width), down = make_taps(image.height, height);
  const Transfer transfer(channels);
  Image result(width, height);
  parallel_for(static_cast<std::size_t>(height), kRowsATask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) {
      for (int x = 0; x < width; ++x) {
        const Vec3 value = average(image, across[static_cast<std::size_t>(x)], down[y], transfer);
        std::uint8_t* const pixel = result.pixel(x, static_cast<int>(y));
        for (int c = 0; c < 3; ++c)
          pixel[c] = transfer.encode(value[c]);
        pixel[3] = 255;
      }
    }
  });
  return result;
}

}  // namespace limn
