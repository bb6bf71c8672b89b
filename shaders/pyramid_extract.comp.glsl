#version 450 core
// Finds each entry's element by descending a histogram pyramid: at every level into the child whose range of entries holds the key.

#include "compute.glsl"
#include "compaction_entry.glsl"

layout(binding = 0) uniform usampler2D pyramid;
layout(std430, binding = 4) readonly buffer Command { uint command[8]; };

uniform int top_level;

void main() {
  uint at = invocation_index();
  if (at >= command[1]) return;
  uint key = at;
  ivec2 texel = ivec2(0);
  uint element = 0u;
  for (int level = top_level - 1; level >= 0; --level) {
    texel *= 2;
    uint a = texelFetch(pyramid, texel, level).x;
    uint b = a + texelFetch(pyramid, texel + ivec2(1, 0), level).x;
    uint c = b + texelFetch(pyramid, texel + ivec2(0, 1), level).x;
    uint child = uint(key >= a) + uint(key >= b) + uint(key >= c);
    key -= child == 0u ? 0u : child == 1u ? a : child == 2u ? b : c;
    texel += ivec2(child & 1u, child >> 1);
    element = element * 4u + child;
  }
  write_entry(at, element, key);
}
