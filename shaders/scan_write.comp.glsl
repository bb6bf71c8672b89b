#version 450 core
// Reduce, then scan, 3 of 3: each block writes its entries.

#include "compute.glsl"
#include "compaction_entry.glsl"
#include "scan.glsl"

layout(std430, binding = 0) readonly buffer Counts { uvec4 counts[]; };
layout(std430, binding = 1) readonly buffer Blocks { uint blocks[]; };

uniform uint block_count;
uniform uint capacity;

void main() {
  uint block = workgroup_index();
  if (block >= block_count) return;
  uint first = block * kBlock + gl_LocalInvocationIndex * kItems;
  uvec4 c[kItems / 4u];
  uint sum = 0u;
  for (uint i = 0u; i < kItems / 4u; ++i) {
    c[i] = counts[first / 4u + i];
    sum += c[i].x + c[i].y + c[i].z + c[i].w;
  }
  uint total;
  uint at = blocks[block] + exclusive_scan(sum, total);
  if (sum == 0u) return;
  for (uint i = 0u; i < kItems; ++i) {
    uint count = c[i / 4u][i % 4u];
    for (uint copy = 0u; copy < count && at < capacity; ++copy, ++at)
      write_entry(at, first + i, copy);
  }
}
