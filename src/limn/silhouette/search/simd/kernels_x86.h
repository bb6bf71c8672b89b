#pragma once

// What the AVX2 and AVX-512 kernels share. Everything is static: each of the two sources, compiled for other
// instructions, has a copy of its own, and none is left for the rest of the program to be linked to.

#include <immintrin.h>

#include "limn/silhouette/search/simd/layout.h"

namespace limn::simd {

/// How many records ahead are fetched: far enough to cover the latency of the last cache level.
static constexpr std::size_t kAhead = 8;

[[maybe_unused]] static inline void prefetch(const void* record, int lines) {
  for (int i = 0; i < lines; ++i)
    _mm_prefetch(static_cast<const char*>(record) + 64 * i, _MM_HINT_T0);
}

/// The distance in eye words that no anchor of the group is beyond.
[[maybe_unused]] static inline int reach_of(const NodeGroup& group, const EyeWords& eye) {
  if (eye.orthographic) return eye.reach;
  const float x = eye.v[0] - eye.scale * group.center[0];
  const float y = eye.v[1] - eye.scale * group.center[1];
  const float z = eye.v[2] - eye.scale * group.center[2];
  const float length = _mm_cvtss_f32(_mm_sqrt_ss(_mm_set_ss(x * x + y * y + z * z)));
  return static_cast<int>(length + eye.scale * group.radius) + 1;
}

}  // namespace limn::simd
