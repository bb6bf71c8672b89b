#version 450 core
// Reads the number of entries from a histogram pyramid's top.

#include "compute.glsl"
#include "compaction_command.glsl"

layout(binding = 0, r32ui) readonly uniform uimage2D top;

void main() {
  if (gl_LocalInvocationIndex == 0u) write_command(imageLoad(top, ivec2(0)).x);
}
