#version 450 core
// Counting sort, 3 of 3: the refined faces by group, in ascending order within each.

#include "refine_selection.glsl"
#include "refine_sort.glsl"

void main() {
  if (workgroup_index() >= frame[7]) return;
  uint count = refined_of_block();
  load_groups(count);
  uint first = workgroup_index() * kSortBlock;
  for (uint group = gl_LocalInvocationIndex; group < group_count; group += kWorkgroupSize) {
    uint to = group_counts[workgroup_index() * group_count + group];
    for (uint i = 0u; i < count; ++i) {
      if (block_keys[i] != group) continue;
      uint slot = refined_slot(first + i);
      keys[to++] = list_entry(lists[slot], lists[slot + 1u]);
    }
  }
}
