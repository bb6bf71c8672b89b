#include "limn/refine/patterns/pattern.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <utility>

#include "limn/refine/patterns/minimal.h"
#include "limn/refine/patterns/nested.h"

namespace limn {
namespace {

constexpr std::uint32_t choose2(std::uint32_t n) {
  return n < 2 ? 0 : n * (n - 1) / 2;
}
constexpr std::uint32_t choose3(std::uint32_t n) {
  return n < 3 ? 0 : n * (n - 1) * (n - 2) / 6;
}
constexpr std::uint32_t choose4(std::uint32_t n) {
  return n < 4 ? 0 : n * (n - 1) * (n - 2) * (n - 3) / 24;
}

/// The largest level n with count(n) <= index.
template <class Count>
std::uint8_t last_below(std::uint32_t index, const Count& count) {
  std::uint8_t level = 0;
  while (count(level + 1u) <= index)
    ++level;
  return level;
}

std::uint32_t base_of(PatternFamily family, std::uint32_t m, std::uint32_t i, std::uint32_t j, std::uint32_t k) {
  if (family == PatternFamily::kMinimal) return choose3(i + 2) + choose2(j + 1) + k;
  return choose4(i + 3) + choose3(i - m + 2) + choose2(j - m + 1) + k - m;
}

}  // namespace

std::uint8_t sorting_lambda(const std::array<std::uint8_t, 3>& sides) {
  std::uint8_t i = sides[0];
  std::uint8_t j = sides[1];
  std::uint8_t k = sides[2];
  unsigned lambda = 0;
  if (i < j) {
    std::swap(i, j);
    lambda += 1;
  }
  if (i < k) {
    std::swap(i, k);
    lambda += 2;
  }
  if (j < k) lambda += 4;
  return static_cast<std::uint8_t>(lambda);
}

PatternChoice choose_pattern(PatternFamily family, const PatternConfig& config) {
  std::array<std::uint8_t, 3> sorted = config.sides;
  std::sort(sorted.begin(), sorted.end(), std::greater<>());
  assert(sorted[0] <= kMaxPatternLevel && (family == PatternFamily::kMinimal || config.inner <= sorted[2]));
  const std::uint8_t lambda = sorting_lambda(config.sides);
  return {base_of(family, config.inner, sorted[0], sorted[1], sorted[2]), kPermutationOfLambda[lambda],
          std::popcount(lambda) % 2 != 0};
}

std::uint32_t pattern_count(PatternFamily family, int max_level) {
  const auto levels = static_cast<std::uint32_t>(max_level);
  return family == PatternFamily::kMinimal ? choose3(levels + 3) : choose4(levels + 4);
}

PatternConfig pattern_config(PatternFamily family, std::uint32_t base) {
  PatternConfig config;
  if (family == PatternFamily::kMinimal) {
    config.sides[0] = last_below(base, [](std::uint32_t i) { return choose3(i + 2); });
    base -= choose3(config.sides[0] + 2u);
  } else {
    config.sides[0] = last_below(base, [](std::uint32_t i) { return choose4(i + 3); });
    base -= choose4(config.sides[0] + 3u);
    const std::uint8_t depth = last_below(base, [](std::uint32_t d) { return choose3(d + 2); });
    base -= choose3(depth + 2u);
    config.inner = static_cast<std::uint8_t>(config.sides[0] - depth);
  }
  const std::uint8_t j = last_below(base, [](std::uint32_t d) { return choose2(d + 1); });
  config.sides[1] = static_cast<std::uint8_t>(config.inner + j);
  config.sides[2] = static_cast<std::uint8_t>(config.inner + base - choose2(j + 1u));
  return config;
}

std::uint16_t Pattern::on_side(int c, int q) const {
  const auto side = static_cast<std::size_t>(c);
  if (q == 0) return static_cast<std::uint16_t>(c);
  if (q == 1 << config.sides[side]) return static_cast<std::uint16_t>((c + 1) % 3);
  int first = 3;
  for (std::size_t before = 0; before < side; ++before)
    first += (1 << config.sides[before]) - 1;
  return static_cast<std::uint16_t>(first + q - 1);
}

Pattern make_pattern(PatternFamily family, const PatternConfig& config) {
  assert(config.sides[0] >= config.sides[1] && config.sides[1] >= config.sides[2]);
  assert(config.sides[0] <= kMaxPatternLevel);
  if (family == PatternFamily::kMinimal) return make_minimal_pattern(config.sides);
  assert(config.inner <= config.sides[2]);
  return make_nested_pattern(config);
}

}  // namespace limn
