#version 450 core
// What is read back of every tagged face of a deforming mesh: its index, its corners, and their normals in polar coordinates, which
// makes four texels (Dyken et al. 2008, section 6.2).

#include "compute.glsl"
#include "refine_scene.glsl"

layout(std430, binding = 1) readonly buffer Entries { uint entries[]; };
layout(std430, binding = 2) readonly buffer Command { uint command[8]; };  // render/compaction.h
layout(std430, binding = 3) writeonly buffer Records { uvec4 records[]; };

/// The angle from the z axis, and the angle about it from the x axis; a normal of no length has a negative one.
uvec2 polar(vec3 n) {
  float across = length(n.xy);
  if (n == vec3(0.0)) return floatBitsToUint(vec2(-1.0, 0.0));
  return floatBitsToUint(vec2(atan(across, n.z), across > 0.0 ? atan(n.y, n.x) : 0.0));
}

void main() {
  uint i = invocation_index();
  if (i >= command[1]) return;
  uint face = entries[i];
  uvec3 v = texelFetch(face_vertices, int(face)).xyz;
  uvec2 n0 = polar(normal_of(v.x)), n1 = polar(normal_of(v.y)), n2 = polar(normal_of(v.z));
  records[4u * i] = uvec4(texelFetch(positions, int(v.x)).xyz, face);
  records[4u * i + 1u] = uvec4(texelFetch(positions, int(v.y)).xyz, n0.x);
  records[4u * i + 2u] = uvec4(texelFetch(positions, int(v.z)).xyz, n0.y);
  records[4u * i + 3u] = uvec4(n1, n2);
}
