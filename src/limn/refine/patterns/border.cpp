#include "limn/refine/patterns/border.h"

namespace limn {

Pattern pattern_border(const PatternConfig& config) {
  Pattern pattern;
  pattern.config = config;
  const std::uint8_t level = config.sides[0];
  const int n = 1 << level;
  const auto add = [&](int j, int k) {
    pattern.vertices.push_back({static_cast<std::uint16_t>(j), static_cast<std::uint16_t>(k), level});
  };
  add(0, 0);
  add(n, 0);
  add(0, n);
  for (std::size_t c = 0; c < 3; ++c) {
    const int step = n >> config.sides[c];
    for (int at = step; at < n; at += step) {
      if (c == 0) add(at, 0);
      if (c == 1) add(n - at, at);
      if (c == 2) add(0, n - at);
    }
  }
  return pattern;
}

}  // namespace limn
