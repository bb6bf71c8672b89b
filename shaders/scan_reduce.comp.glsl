#version 450 core
// Reduce, then scan, 1 of 3: the sum of each block of counts.

#include "compute.glsl"
#include "scan.glsl"

layout(std430, binding = 0) readonly buffer Counts { uvec4 counts[]; };
layout(std430, binding = 1) writeonly buffer Blocks { uint blocks[]; };

uniform uint block_count;

void main() {
  uint block = workgroup_index();
  if (block >= block_count) return;
  uint t = gl_LocalInvocationIndex;
  uint first = block * (kBlock / 4u) + t;
  uint sum = 0u;
  for (uint i = 0u; i < kItems / 4u; ++i) {
    uvec4 c = counts[first + i * kWorkgroupSize];
    sum += c.x + c.y + c.z + c.w;
  }
  scanned[t] = sum;
  for (uint half_size = kWorkgroupSize / 2u; half_size > 0u; half_size /= 2u) {
    barrier();
    if (t < half_size) scanned[t] += scanned[t + half_size];
  }
  if (t == 0u) blocks[block] = scanned[0];
}
