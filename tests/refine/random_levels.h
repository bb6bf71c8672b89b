#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "limn/base/random.h"

namespace limn {

/// Levels in [0, max_level].
inline std::vector<float> random_levels(Random& random, std::size_t edges, int max_level) {
  std::vector<float> levels(edges);
  for (float& level : levels) {
    // Integers and zeros often, since that is where the cases change.
    const double s = random.uniform(0.0, max_level);
    level = static_cast<float>(random.below(3) == 0 ? std::floor(s) : s);
    if (random.below(3) == 0) level = 0;
  }
  return levels;
}

}  // namespace limn
