#version 450 core
// Counting sort, 2 of 3, one workgroup: where each block's faces of each group go, and each group's draw commands. Groups begin
// at multiples of the most faces that share an instance; what is left free there is marked.

#include "refine_selection.glsl"
#include "scan.glsl"

layout(std430, binding = 6) buffer Commands { uint commands[]; };
#include "refine_groups.glsl"

void write_command(uint at, uint index_count, uint instances, uint first_index, uint base_vertex, uint base_instance) {
  commands[at] = index_count;
  commands[at + 1u] = instances;
  commands[at + 2u] = first_index;
  commands[at + 3u] = base_vertex;
  commands[at + 4u] = base_instance;
}

/// Three commands a group, one for each way to feed instances: four faces each, one, or batches of stored vertices.
void write_commands(uint group, uint start, uint total) {
  PatternDraw d = draws[(group + 2u) / 2u];
  bool several = d.faces_an_instance > 1u;
  uint instances = (total + d.faces_an_instance - 1u) / d.faces_an_instance;
  uint at = kFirstCommand + group * kCommandUints;
  uint stride = group_count * kCommandUints;
  write_command(at, d.index_count, several ? instances : 0u, d.first_index[group & 1u], d.base_vertex, start / d.faces_an_instance);
  write_command(at + stride, d.index_count, several ? 0u : instances, d.first_index[group & 1u], d.base_vertex, start);
  write_command(at + 2u * stride, d.batch_index_count, (total + d.batch - 1u) / d.batch, d.batch_first_index[group & 1u], 0u, start);
}

uint padded(uint count) { return (count + kAlignment - 1u) & ~(kAlignment - 1u); }

void main() {
  uint t = gl_LocalInvocationIndex;
  uint block_count = frame[7];
  uint entries = 0u;
  uint vertices = 0u;
  for (uint first = 0u; first < group_count; first += kWorkgroupSize) {
    uint group = first + t;
    uint total = 0u;
    for (uint block = 0u; block < block_count && group < group_count; ++block) {
      uint at = block * group_count + group;
      uint n = group_counts[at];
      group_counts[at] = total;
      total += n;
    }
    uint all;
    uint start = entries + exclusive_scan(padded(total), all);
    entries += all;
    uint vertex = vertices + exclusive_scan(padded(total) * draws[(min(group, group_count - 1u) + 2u) / 2u].vertices, all);
    vertices += all;
    if (group >= group_count) continue;
    put_group(group, GroupRange(start, total, vertex));
    for (uint i = start + total; i < start + padded(total); ++i)
      keys[i] = kNoFace;
    for (uint block = 0u; block < block_count; ++block)
      group_counts[block * group_count + group] += start;
    write_commands(group, start, total);
  }
  if (t != 0u) return;
  uint groups = (entries + kWorkgroupSize - 1u) / kWorkgroupSize;  // a dispatch over the sorted entries
  frame[40] = min(groups, kWorkgroupsARow);
  frame[41] = (groups + kWorkgroupsARow - 1u) / kWorkgroupsARow;
  frame[42] = 1u;
  frame[43] = entries;
}
