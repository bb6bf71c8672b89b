#version 450 core
// A vertex of a pattern that is drawn for one face, whose data are uniforms. The pattern lies on the face as stored.

#include "refine_emit_face.glsl"
#include "refine_pattern_vertex.glsl"

layout(location = 0) in uint pattern_vertex;

uniform uint drawn_face;  // for what is captured alone

void main() {
  RefinedFace f;
  f.instance = 0u;
  f.vertices = uvec3(0u, 1u, 2u);
  for (uint c = 0u; c < 3u; ++c) f.edges[c] = c | (runs_backwards(c) ? kReversed : 0u);
  int n = pattern_level(pattern_vertex);
  ivec3 ijk = pattern_weights(pattern_vertex);
  emit_face_vertex(f, drawn_face, unblended_point(f, ijk, n), ijk, n);
}
