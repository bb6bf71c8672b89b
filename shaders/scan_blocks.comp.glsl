#version 450 core
// Reduce, then scan, 2 of 3: one workgroup turns the blocks' sums into where their entries begin.

#include "compute.glsl"
#include "compaction_command.glsl"
#include "scan.glsl"

layout(std430, binding = 1) buffer Blocks { uint blocks[]; };

uniform uint block_count;

void main() {
  uint t = gl_LocalInvocationIndex;
  uint carried = 0u;
  for (uint first = 0u; first < block_count; first += kWorkgroupSize) {
    uint block = first + t;
    uint total;
    uint before = exclusive_scan(block < block_count ? blocks[block] : 0u, total);
    if (block < block_count) blocks[block] = carried + before;
    carried += total;
  }
  if (t == 0u) write_command(carried);
}
