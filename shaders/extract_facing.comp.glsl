#version 450 core
// Facing of every face of a scene, each from its own object's eye: 1 front, 0 back.

#include "compute.glsl"
#include "facing.glsl"

layout(binding = 0) uniform usamplerBuffer planes;        // bits of nx, ny, nz, d
layout(binding = 1) uniform usamplerBuffer face_objects;
layout(std430, binding = 0) readonly buffer Eyes { uvec4 eyes[]; };
layout(std430, binding = 1) writeonly buffer Facing { uint facing[]; };

uniform uint face_count;

void main() {
  uint f = invocation_index();
  if (f >= face_count) return;
  uint object = texelFetch(face_objects, int(f)).x;
  facing[f] = faces_eye(texelFetch(planes, int(f)), eyes[object]) ? 1u : 0u;
}
