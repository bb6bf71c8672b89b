#version 450 core
// Levels of a patch: as many segments a side as its edge's level asks for, inside as many as on the finest side. Corners pass
// unchanged, so that no invocation waits for another; the patch's middle is found here, once.

#include "refine_levels.glsl"
#include "refine_surface.glsl"
#include "refine_tess_corner.glsl"

layout(vertices = 3) out;

in Corner CORNER corners[];
out Point CORNER points[];
patch out vec3 center;

float segments(uint side) {
  if (side == kNoPatch) return 0.0;  // not drawn
  uint level = side & ~kBackwards;
#if FRACTIONAL
  return ldexp(exp2(float(level & (kLevelOne - 1u)) * kLevelUnit), int(level >> 12));  // exact at whole levels
#else
  return float(1u << level_ceil(level));
#endif
}

void main() {
  points[gl_InvocationID].point = corners[gl_InvocationID].point;
  points[gl_InvocationID].near = corners[gl_InvocationID].near;
  points[gl_InvocationID].far = corners[gl_InvocationID].far;
  points[gl_InvocationID].side = corners[gl_InvocationID].side;
  points[gl_InvocationID].face = corners[gl_InvocationID].face;
#ifndef POSITIONS_ONLY
  points[gl_InvocationID].normal = corners[gl_InvocationID].normal;
  points[gl_InvocationID].uv = corners[gl_InvocationID].uv;
  points[gl_InvocationID].color = corners[gl_InvocationID].color;
  points[gl_InvocationID].material = corners[gl_InvocationID].material;
#endif
  if (gl_InvocationID != 0) return;
  vec3 s = vec3(segments(corners[0].side), segments(corners[1].side), segments(corners[2].side));
  gl_TessLevelOuter[0] = s.y;  // opposite corner 0
  gl_TessLevelOuter[1] = s.z;
  gl_TessLevelOuter[2] = s.x;
  center = patch_center(Patch(vec3[3](corners[0].point, corners[1].point, corners[2].point),
                              vec3[6](corners[0].near, corners[0].far, corners[1].near, corners[1].far, corners[2].near,
                                      corners[2].far), vec3(0.0)));
  gl_TessLevelInner[0] = max(max(s.x, s.y), s.z);
}
