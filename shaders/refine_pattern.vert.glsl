#version 450 core
// A vertex of a pattern, put on the face that its instance names: patterns are drawn as stored, several small ones to an
// instance.

#include "refine_vertex.glsl"
#include "refine_emit.glsl"

layout(location = 0) in uint pattern_vertex;  // j, k and level as pack() leaves them (refine/patterns/pattern.h), bits 24-25 which face
layout(location = 1) in uvec4 faces;          // sorted entries (refine_selection.glsl); one where a pattern has instances of its own

const uint kNoFace = 0xffffffffu;

void main() {
  uint entry = faces[pattern_vertex >> 24];
  if (entry == kNoFace) {
    collapse_vertex();
    return;
  }
  int n = int(pattern_vertex >> 20 & 15u);
  int j = int(pattern_vertex & 1023u);
  int k = int(pattern_vertex >> 10 & 1023u);
  int first = int(entry >> 28 & 3u);
  int second = int(entry >> 30);
  ivec3 ijk;
  ijk[first] = (1 << n) - j - k;
  ijk[second] = j;
  ijk[3 - first - second] = k;
  uint face = entry & 0x0fffffffu;
  RefinedFace f = refined_face(face);
  vec3 point = face_point(f, ijk, n);
  Placement placement = placement_of(f.instance);
  vec3 position = to_world(placement, vec4(point, 1.0));
#ifdef CAPTURED
  captured_position = point;
  captured_source = uvec2(face, uint(ijk.y) | uint(ijk.z) << 12 | uint(n) << 24);
#endif
#ifdef POSITIONS_ONLY
  place_vertex(position);
#else
  vec3 w = vec3(ijk) / float(1 << n);
  emit_surface(position, to_world(placement, vec4(face_normal_at(f, w), 0.0)), face_uv_at(f, w), face_color_at(f, w),
               material_of(f.vertices.x));
#endif
}
