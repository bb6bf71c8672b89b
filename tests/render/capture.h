#pragma once

#include <cstddef>
#include <cstdint>
#include <gtest/gtest.h>
#include <vector>

#include "limn/render/refinement/method.h"

namespace limn::test {

/// A corner of a triangle as a vertex stage placed it (shaders/refine_emit.glsl).
struct CapturedVertex {
  Vec3 position;            ///< in the object's space
  std::uint32_t face = 0;   ///< counted over instances; 0xffffffff: a corner of an unrefined triangle
  std::uint32_t place = 0;  ///< on the face: weights at corners 1 and 2, 12 bits each, and their level; or the vertex

  std::uint32_t j() const { return place & 0xfffu; }
  std::uint32_t k() const { return place >> 12 & 0xfffu; }
  std::uint32_t level() const { return place >> 24; }
};
static_assert(sizeof(CapturedVertex) == 20);

/// What a method draws, corner by corner in the order drawn, without rasterizing.
/// \param most  corners there is room for; a failed test when there are more
std::vector<CapturedVertex> capture(RefinementMethod& method, std::size_t most);

}  // namespace limn::test
