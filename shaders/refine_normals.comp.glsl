#version 450 core
// The unit normal of every face of the objects, or 0: the twin of face_normals() (mesh/normals.h).

#include "compute.glsl"
#include "refine_scene.glsl"
#include "exact_float.glsl"

layout(std430, binding = 0) writeonly buffer FaceNormals { float face_normals[]; };

uniform uint face_count;

dvec3 exact_position(uint v) {
  uvec3 bits = texelFetch(positions, int(v)).xyz;
  return dvec3(exact_value(bits.x), exact_value(bits.y), exact_value(bits.z));
}

void main() {
  uint f = invocation_index();
  if (f >= face_count) return;
  uvec3 v = texelFetch(face_vertices, int(f)).xyz;
  dvec3 p = exact_position(v.x);
  dvec3 a = exact_position(v.y) - p;
  dvec3 b = exact_position(v.z) - p;
  precise dvec3 n = dvec3(a.y * b.z - b.y * a.z, a.z * b.x - b.z * a.x, a.x * b.y - b.x * a.y);
  precise double squared = n.x * n.x + n.y * n.y + n.z * n.z;
  double size = sqrt(squared);
  vec3 unit = size > 0.0lf ? vec3(n / size) : vec3(0.0);
  face_normals[3u * f] = unit.x;
  face_normals[3u * f + 1u] = unit.y;
  face_normals[3u * f + 2u] = unit.z;
}
