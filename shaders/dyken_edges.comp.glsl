#version 450 core
// What is read back of every tagged edge: its index and level; of a deforming mesh, with DEFORMING, its inner control points too
// (Dyken et al. 2008, section 6.2).

#include "compute.glsl"
#include "refine_scene.glsl"
#include "refine_levels.glsl"

layout(std430, binding = 0) readonly buffer Levels { uint levels[]; };
layout(std430, binding = 1) readonly buffer Entries { uint entries[]; };
layout(std430, binding = 2) readonly buffer Command { uint command[8]; };  // render/compaction.h
#ifdef DEFORMING
layout(std430, binding = 3) writeonly buffer Records { uvec4 records[]; };  // two an edge
#else
layout(std430, binding = 3) writeonly buffer Records { uvec2 records[]; };
#endif

void main() {
  uint i = invocation_index();
  if (i >= command[1]) return;
  uint edge = entries[i];
  uint level = level_own(levels[edge]);
#ifdef DEFORMING
  uvec3 first = texelFetch(curves, int(2u * edge)).xyz;
  uvec3 second = texelFetch(curves, int(2u * edge + 1u)).xyz;
  records[2u * i] = uvec4(edge, level, first.xy);
  records[2u * i + 1u] = uvec4(first.z, second);
#else
  records[i] = uvec2(edge, level);
#endif
}
