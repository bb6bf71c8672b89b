#version 450 core
// Selects the faces with an edge whose silhouetteness exceeds a threshold or, with EXACT, that is a silhouette; and all edges of
// selected faces (Dyken et al. 2008, section 6.2).

#include "compute.glsl"

layout(binding = 0) uniform usamplerBuffer face_edges;
layout(std430, binding = 1) writeonly buffer Faces { uint faces[]; };
layout(std430, binding = 2) writeonly buffer FaceEdges { uint edges[]; };  // zeros at first

#ifdef EXACT
layout(std430, binding = 0) readonly buffer Values { uint values[]; };
#else
layout(std430, binding = 0) readonly buffer Values { float values[]; };
uniform float threshold;
#endif

uniform uint face_count;

const uint kInvalidId = 0xffffffffu;

bool is_near(uint edge) {
#ifdef EXACT
  return values[edge] != 0u;
#else
  return values[edge] > threshold;
#endif
}

void main() {
  uint f = invocation_index();
  if (f >= face_count) return;
  uvec3 e = texelFetch(face_edges, int(f)).xyz;
  // A degenerate face has no edges.
  bool selected = e.x != kInvalidId && (is_near(e.x) || is_near(e.y) || is_near(e.z));
  faces[f] = selected ? 1u : 0u;
  if (!selected) return;
  // From the faces, since any number of them may meet at an edge: all write the same.
  edges[e.x] = 1u;
  edges[e.y] = 1u;
  edges[e.z] = 1u;
}
