#version 450 core
// A corner of the refined mesh's stream, placed on its face.

#include "refine_emit_face.glsl"
#include "refine_pattern_vertex.glsl"
#include "refine_stream.glsl"

void main() {
  int n = pattern_level(stream_corner.y);
  ivec3 ijk = pattern_weights(stream_corner.y);
  RefinedFace f = face_tables_of(stream_corner.x);
  emit_face_vertex(f, stream_corner.x, unblended_point(f, ijk, n), ijk, n);
}
