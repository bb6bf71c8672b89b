#version 450 core
// A histogram pyramid's base level: the number of entries of each element.

#include "compute.glsl"
#include "morton.glsl"

layout(std430, binding = 0) readonly buffer Counts { uint counts[]; };
layout(binding = 0, r32ui) writeonly uniform uimage2D base;

uniform uint element_count;

void main() {
  uint i = invocation_index();
  if (i < element_count) imageStore(base, texel_of(i), uvec4(counts[i]));
}
