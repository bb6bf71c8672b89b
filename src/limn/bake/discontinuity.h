#pragma once

#include <cstddef>
#include <vector>

#include "limn/bake/bake.h"
#include "limn/base/result.h"

namespace limn {

/// How often neighbouring texels found places on the high mesh that are not neighbours: the gaps of the paper's figures
/// 4 and 5.
struct Discontinuities {
  std::size_t pairs = 0;            ///< texels side by side or one above the other, both centres within one face
  std::size_t breaks = 0;           ///< of those: farther apart on the high mesh than `factor` times on the low one
  std::vector<std::uint8_t> marks;  ///< one a texel: 1 where it is part of a break

  double share() const { return pairs > 0 ? static_cast<double>(breaks) / static_cast<double>(pairs) : 0.0; }
};

/// Counts them. A slope of the high mesh stretches distances as well, by 1 / cosine: a factor of 8 tells breaks from
/// slopes up to 83°.
/// Cost: two passes over the texels, one thread.
/// Errors: kInvalidArgument when the maps hold no positions, or for a factor that is not above 0.
Result<Discontinuities> find_discontinuities(const BakedMaps& maps, double factor);

}  // namespace limn
