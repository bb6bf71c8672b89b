#version 450 core
// Counting sort, 1 of 3: how many faces of each group a block has.

#include "refine_selection.glsl"
#include "refine_sort.glsl"

void main() {
  if (workgroup_index() >= frame[7]) return;
  uint count = refined_of_block();
  load_groups(count);
  for (uint group = gl_LocalInvocationIndex; group < group_count; group += kWorkgroupSize) {
    uint n = 0u;
    for (uint i = 0u; i < count; ++i)
      n += block_keys[i] == group ? 1u : 0u;
    group_counts[workgroup_index() * group_count + group] = n;
  }
}
