#version 450 core
// A vertex of a pattern that is drawn for a group of faces, one an instance. With SNAPPED patterns are uniform and their border is
// merged to the sides' own segments (Dyken, Reimers and Seland 2009); else they are adaptive and turned (Lenz et al. 2009).

#include "refine_emit_face.glsl"
#include "refine_pattern_vertex.glsl"

layout(location = 0) in uint pattern_vertex;
layout(location = 1) in uvec2 grouped_face;  // the face; corners 0 and 1, two bits each, or with SNAPPED log2 of the sides' segments, four bits each

#ifdef SNAPPED
/// k / 2^n moved to the nearest multiple of 2^-level, of two that are as near to the one farther from the middle.
int snapped(int k, int n, int level) {
  if (level >= n) return k;
  int d = n - level;
  int half_step = 1 << (d - 1);
  return (2 * k <= 1 << n ? k + half_step - 1 : k + half_step) >> d << d;
}

ivec3 place_on_face(ivec3 ijk, int n, uint levels) {
  for (int c = 0; c < 3; ++c) {
    int next = c == 2 ? 0 : c + 1;
    if (ijk[3 - c - next] != 0) continue;
    ijk[next] = snapped(ijk[next], n, int(levels >> 4 * c & 15u));
    ijk[c] = (1 << n) - ijk[next];
  }
  return ijk;
}
#else
ivec3 place_on_face(ivec3 ijk, int n, uint corners) { return weights_on_face(ijk, corners); }
#endif

void main() {
  int n = pattern_level(pattern_vertex);
  ivec3 ijk = place_on_face(pattern_weights(pattern_vertex), n, grouped_face.y);
  RefinedFace f = face_tables_of(grouped_face.x);
  emit_face_vertex(f, grouped_face.x, unblended_point(f, ijk, n), ijk, n);
}
