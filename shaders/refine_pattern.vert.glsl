#version 450 core
// A vertex of a pattern, put on the face that its instance names: patterns are drawn as stored, several small ones to an
// instance.

#include "refine_emit_face.glsl"
#include "refine_pattern_vertex.glsl"

layout(location = 0) in uint pattern_vertex;  // as pack() leaves it (refine/patterns/pattern.h), bits 24-25 which face
layout(location = 1) in uvec4 faces;          // sorted entries (refine_selection.glsl); one where a pattern has instances of its own

const uint kNoFace = 0xffffffffu;

void main() {
  uint entry = faces[pattern_vertex >> 24];
  if (entry == kNoFace) {
    collapse_vertex();
    return;
  }
  int n = pattern_level(pattern_vertex);
  ivec3 ijk = weights_on_face(pattern_weights(pattern_vertex), entry >> 28);
  uint face = entry & 0x0fffffffu;
  RefinedFace f = refined_face(face);
  emit_face_vertex(f, face, face_point(f, ijk, n), ijk, n);
}
