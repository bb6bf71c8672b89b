#include "limn/bake/picture_pyramid.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "limn/image/srgb.h"

namespace limn::bake_detail {
namespace {

Vec4 linear_pixel(const Image& image, int x, int y) {
  const std::uint8_t* const pixel = image.pixel(x, y);
  return {linear_of_srgb(pixel[0]), linear_of_srgb(pixel[1]), linear_of_srgb(pixel[2]),
          static_cast<float>(pixel[3]) / 255.0f};
}

Image halved(const Image& image) {
  Image half(std::max(image.width / 2, 1), std::max(image.height / 2, 1));
  for (int y = 0; y < half.height; ++y) {
    for (int x = 0; x < half.width; ++x) {
      const int x1 = std::min(2 * x + 1, image.width - 1), y1 = std::min(2 * y + 1, image.height - 1);
      const Vec4 mean = (linear_pixel(image, 2 * x, 2 * y) + linear_pixel(image, x1, 2 * y) +
                         linear_pixel(image, 2 * x, y1) + linear_pixel(image, x1, y1)) *
                        0.25f;
      std::uint8_t* const pixel = half.pixel(x, y);
      for (int c = 0; c < 3; ++c)
        pixel[c] = static_cast<std::uint8_t>(std::lround(255.0f * srgb_of_linear(mean[c])));
      pixel[3] = static_cast<std::uint8_t>(std::lround(255.0f * mean.a));
    }
  }
  return half;
}

int wrapped(int index, int size) {
  const int rest = index % size;
  return rest < 0 ? rest + size : rest;
}

Vec4 bilinear(const Image& image, const Vec2& uv) {
  const auto place = [](float share, int size) {
    return (share - std::floor(share)) * static_cast<float>(size) - 0.5f;
  };
  const float x = place(uv.x, image.width), y = place(1.0f - uv.y, image.height);
  const float left = std::floor(x), top = std::floor(y);
  const int x0 = wrapped(static_cast<int>(left), image.width), y0 = wrapped(static_cast<int>(top), image.height);
  const int x1 = wrapped(x0 + 1, image.width), y1 = wrapped(y0 + 1, image.height);
  const float a = x - left, b = y - top;
  const Vec4 upper = linear_pixel(image, x0, y0) * (1.0f - a) + linear_pixel(image, x1, y0) * a;
  const Vec4 lower = linear_pixel(image, x0, y1) * (1.0f - a) + linear_pixel(image, x1, y1) * a;
  return upper * (1.0f - b) + lower * b;
}

}  // namespace

PicturePyramid::PicturePyramid(Image picture) {
  if (picture.width < 1 || picture.height < 1) return;
  levels_.push_back(std::move(picture));
  while (levels_.back().width > 1 || levels_.back().height > 1)
    levels_.push_back(halved(levels_.back()));
}

Vec4 PicturePyramid::sample(const Vec2& uv, float level) const {
  if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) return Vec4(1.0f);
  const float last = static_cast<float>(levels_.size() - 1);
  const float clamped = level > 0.0f ? std::min(level, last) : 0.0f;
  const auto lower = static_cast<std::size_t>(clamped);
  const float share = clamped - static_cast<float>(lower);
  const Vec4 fine = bilinear(levels_[lower], uv);
  return share > 0.0f ? fine * (1.0f - share) + bilinear(levels_[lower + 1], uv) * share : fine;
}

}  // namespace limn::bake_detail
