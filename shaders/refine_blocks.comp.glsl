#version 450 core
// One workgroup: where each block's unrefined and refined faces go, and the commands that follow from how many there are.

#include "refine_selection.glsl"
#include "scan.glsl"

layout(std430, binding = 6) writeonly buffer Commands { uint commands[]; };  // see pattern_selection.cpp

void main() {
  uint t = gl_LocalInvocationIndex;
  uint block_count = face_capacity / kWorkgroupSize;
  uvec2 carried = uvec2(0u);
  for (uint first = 0u; first < block_count; first += kWorkgroupSize) {
    uint block = first + t;
    uvec2 count = block < block_count ? blocks[block] : uvec2(0u);
    uvec2 total;
    uvec2 before;
    before.x = exclusive_scan(count.x, total.x);
    before.y = exclusive_scan(count.y, total.y);
    if (block < block_count) blocks[block] = carried + before;
    carried += total;
  }
  if (t != 0u) return;
  frame[1] = carried.x;
  frame[2] = carried.y;
  commands[0] = 3u * carried.x;  // indices of the unrefined triangles
  commands[1] = 1u;
  uint groups = (carried.y + kSortBlock - 1u) / kSortBlock;
  frame[4] = min(groups, kWorkgroupsARow);
  frame[5] = (groups + kWorkgroupsARow - 1u) / kWorkgroupsARow;
  frame[6] = 1u;
  frame[7] = groups;
}
