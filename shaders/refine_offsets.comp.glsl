#version 450 core
// Counting sort, 2 of 3, one workgroup: where each block's faces of each group go, and each group's draw command. Groups begin
// at multiples of four, the most faces that share an instance; what is left free there is marked.

#include "refine_selection.glsl"
#include "scan.glsl"

layout(std430, binding = 6) writeonly buffer Commands { uint commands[]; };
struct PatternDraw {
  uint index_count;  // of all faces of an instance
  uint first_index[2];
  uint base_vertex;
  uint faces_an_instance;  // 4 or 1
  uint triangles;          // of one face
};
layout(std430, binding = 7) readonly buffer Draws { PatternDraw draws[]; };

const uint kNoFace = 0xffffffffu;
const uint kCommandUints = 5u;
const uint kFirstCommand = 5u;  // behind that of the unrefined triangles

shared uint group_totals[kWorkgroupSize];

void write_commands(uint group, uint start, uint total) {
  PatternDraw d = draws[(group + 2u) / 2u];
  bool several = d.faces_an_instance > 1u;
  // Two commands a group, one for each way to feed instances; the other draws none.
  for (uint kind = 0u; kind < 2u; ++kind) {
    uint at = kFirstCommand + (kind * group_count + group) * kCommandUints;
    bool drawn = (kind == 0u) == several;
    commands[at] = d.index_count;
    commands[at + 1u] = drawn ? (total + d.faces_an_instance - 1u) / d.faces_an_instance : 0u;
    commands[at + 2u] = d.first_index[group & 1u];
    commands[at + 3u] = d.base_vertex;
    commands[at + 4u] = start / d.faces_an_instance;
  }
}

void main() {
  uint t = gl_LocalInvocationIndex;
  uint block_count = frame[7];
  uint carried = 0u;
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
    uint start = carried + exclusive_scan((total + 3u) & ~3u, all);
    carried += all;
    if (group >= group_count) continue;
    for (uint i = start + total; i < start + ((total + 3u) & ~3u); ++i)
      keys[i] = kNoFace;
    for (uint block = 0u; block < block_count; ++block)
      group_counts[block * group_count + group] += start;
    write_commands(group, start, total);
  }
}
