#version 450 core
// Counting sort, 3 of 3: the refined faces by group, in ascending order within each.

#include "refine_selection.glsl"
#include "refine_sort.glsl"

layout(std430, binding = 6) buffer Commands { uint commands[]; };
#include "refine_groups.glsl"

uint group_end(uint group) {
  GroupRange range = group_range(group);
  return range.start + range.count;
}

void main() {
  if (workgroup_index() >= frame[7]) return;
  uint count = refined_of_block();
  load_groups(count);
  uint first = workgroup_index() * kSortBlock;
  bool last = workgroup_index() + 1u == frame[7];
  for (uint group = gl_LocalInvocationIndex; group < group_count; group += kWorkgroupSize) {
    uint to = group_counts[workgroup_index() * group_count + group];
    uint next = last ? group_end(group) : group_counts[(workgroup_index() + 1u) * group_count + group];
    if (to == next) continue;  // most groups are not in most blocks
    for (uint i = 0u; i < count; ++i) {
      if (block_keys[i] != group) continue;
      uint slot = refined_slot(first + i);
      keys[to++] = list_entry(lists[slot], lists[slot + 1u]);
    }
  }
}
