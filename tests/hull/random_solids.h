#pragma once

#include <cstdint>

#include "limn/mesh/mesh.h"

namespace limn::test {

/// A closed surface, another one for every seed: smooth and rough balls, knots and rings, parts that cross each other,
/// parts inside parts, cavities, surfaces jittered until they cross themselves; 80 to some thousand faces.
Mesh random_solid(std::uint64_t seed);

}  // namespace limn::test
