#version 450 core
// For every edge of a scene whether it is a silhouette and, with SILHOUETTENESS, how nearly.

#include "compute.glsl"
#include "silhouetteness.glsl"

layout(binding = 0) uniform usamplerBuffer edge_faces;    // two ids, the same one twice where an edge has not two faces
layout(std430, binding = 0) readonly buffer Facing { uint facing[]; };
layout(std430, binding = 1) writeonly buffer Silhouettes { uint silhouettes[]; };

#ifdef SILHOUETTENESS
layout(binding = 1) uniform usamplerBuffer planes;
layout(binding = 2) uniform usamplerBuffer face_objects;
layout(binding = 3) uniform usamplerBuffer edge_middles;  // bits of x, y, z and β; β = 0: always 1
layout(std430, binding = 2) readonly buffer Eyes { uvec4 eyes[]; };
layout(std430, binding = 3) writeonly buffer Alphas { float alphas[]; };

dvec3 exact_point(uvec3 bits) {
  return dvec3(exact_value(bits.x), exact_value(bits.y), exact_value(bits.z));
}

float edge_silhouetteness(uint e, uvec2 faces) {
  uvec4 middle = texelFetch(edge_middles, int(e));
  float beta = uintBitsToFloat(middle.w);
  if (beta == 0.0) return 1.0;
  uvec4 eye = eyes[texelFetch(face_objects, int(faces.x)).x];
  bool orthographic = (eye.w & 1u) != 0u;
  vec3 d = unit_direction(exact_point(eye.xyz), orthographic ? dvec3(0.0lf) : exact_point(middle.xyz));
  vec3 ns = uintBitsToFloat(texelFetch(planes, int(faces.x)).xyz);
  vec3 nt = uintBitsToFloat(texelFetch(planes, int(faces.y)).xyz);
  return silhouetteness(silhouette_product(d, ns, nt), beta);
}
#endif

uniform uint edge_count;

void main() {
  uint e = invocation_index();
  if (e >= edge_count) return;
  uvec2 faces = texelFetch(edge_faces, int(e)).xy;
  silhouettes[e] = facing[faces.x] ^ facing[faces.y];
#ifdef SILHOUETTENESS
  alphas[e] = edge_silhouetteness(e, faces);
#endif
}
