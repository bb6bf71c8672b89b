#version 450 core
// The next level of a histogram pyramid: each texel the sum of four.

#include "compute.glsl"
#include "morton.glsl"

layout(binding = 0, r32ui) readonly uniform uimage2D finer;
layout(binding = 1, r32ui) writeonly uniform uimage2D coarser;

uniform uint texel_count;  // of the coarser level, along its Morton curve; those behind stay 0

void main() {
  uint i = invocation_index();
  if (i >= texel_count) return;
  ivec2 at = texel_of(i);
  ivec2 child = 2 * at;
  uint sum = imageLoad(finer, child).x + imageLoad(finer, child + ivec2(1, 0)).x + imageLoad(finer, child + ivec2(0, 1)).x +
             imageLoad(finer, child + ivec2(1, 1)).x;
  imageStore(coarser, at, uvec4(sum));
}
