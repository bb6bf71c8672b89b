#include "limn/compare/distance_transform.h"

#include <algorithm>
#include <cassert>
#include <cstddef>

#include "limn/base/parallel.h"

namespace limn {
namespace {

// More than any distance in a picture, and small enough to be counted up from.
constexpr std::int32_t kNone = 1 << 20;

// Distance to the nearest site in the same column, kNone or more in columns without one. Row by row, so that memory is
// read in order.
std::vector<std::int32_t> column_distances(std::span<const std::uint8_t> sites, std::size_t width, std::size_t height) {
  std::vector<std::int32_t> distances(sites.size());
  const std::vector<std::int32_t> no_row(width, kNone);
  parallel_for(width, 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = 0; y < height; ++y) {
      const std::uint8_t* site = sites.data() + y * width;
      std::int32_t* here = distances.data() + y * width;
      const std::int32_t* above = y > 0 ? here - width : no_row.data();
      for (std::size_t x = begin; x < end; ++x)
        here[x] = site[x] != 0 ? 0 : above[x] + 1;
    }
    for (std::size_t y = height - 1; y-- > 0;) {
      std::int32_t* here = distances.data() + y * width;
      const std::int32_t* below = here + width;
      for (std::size_t x = begin; x < end; ++x)
        here[x] = std::min(here[x], below[x] + 1);
    }
  });
  return distances;
}

// One parabola (x - at)² + height of the lower envelope, and the first pixel at which it is the lowest. Everything here
// stays below 2 · 16384² = 2^29.
struct Parabola {
  std::int32_t at;
  std::int32_t start;
  std::int32_t height;
};

// The first whole x at which the parabola at `right` lies below `left`. \pre left.at < right
std::int32_t first_below(const Parabola& left, std::int32_t right, std::int32_t right_height) {
  const std::int32_t numerator = (right_height + right * right) - (left.height + left.at * left.at);
  if (numerator < 0) return 0;
  return numerator / (2 * (right - left.at)) + 1;
}

// The lower envelope of the parabolas over one row of column distances, sampled at each pixel.
void envelope_row(const std::int32_t* columns, std::int32_t width, std::vector<Parabola>& envelope,
                  std::uint32_t* out) {
  envelope.clear();
  for (std::int32_t x = 0; x < width; ++x) {
    if (columns[x] >= kNone) continue;
    const std::int32_t height = columns[x] * columns[x];
    std::int32_t start = 0;
    while (!envelope.empty()) {
      start = first_below(envelope.back(), x, height);
      if (start > envelope.back().start) break;
      envelope.pop_back();
      start = 0;
    }
    if (start < width) envelope.push_back({x, start, height});
  }
  if (envelope.empty()) {
    std::fill(out, out + width, kNoSite);
    return;
  }
  std::size_t lowest = 0;
  for (std::int32_t x = 0; x < width; ++x) {
    while (lowest + 1 < envelope.size() && envelope[lowest + 1].start <= x)
      ++lowest;
    const std::int32_t across = x - envelope[lowest].at;
    out[x] = static_cast<std::uint32_t>(across * across + envelope[lowest].height);
  }
}

}  // namespace

std::vector<std::uint32_t> squared_distances(std::span<const std::uint8_t> sites, int width, int height) {
  assert(width >= 0 && width <= 16384 && height >= 0 && height <= 16384);
  assert(sites.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  std::vector<std::uint32_t> squared(sites.size());
  if (sites.empty()) return squared;
  const std::size_t row = static_cast<std::size_t>(width);
  const std::vector<std::int32_t> columns = column_distances(sites, row, static_cast<std::size_t>(height));
  parallel_for(static_cast<std::size_t>(height), 32, [&](std::size_t begin, std::size_t end) {
    std::vector<Parabola> envelope;
    for (std::size_t y = begin; y < end; ++y) {
      envelope_row(columns.data() + y * row, width, envelope, squared.data() + y * row);
    }
  });
  return squared;
}

}  // namespace limn
