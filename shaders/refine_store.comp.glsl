#version 450 core
// Stores the vertices of every refined face: one invocation a face. Neighbours in the sorted list share a pattern, so that
// invocations side by side run alike.

#include "compute.glsl"
#include "refine_vertex.glsl"
#include "refine_stored.glsl"

layout(binding = 13) uniform usamplerBuffer pattern_vertices;
layout(std430, binding = 1) buffer Frame { uint selection_frame[]; };
layout(std430, binding = 2) readonly buffer Entries { uint entries[]; };
layout(std430, binding = 3) writeonly buffer FirstVertices { uint first_vertices[]; };  // an entry's, where it begins a batch
layout(std430, binding = 6) buffer Commands { uint commands[]; };

uniform uint group_count;

#include "refine_groups.glsl"

void store_side(StoredFace face, EdgeCurve curve, bool reversed, int side, int n, uint at) {
  CurveBend bend = curve_bend(curve);
  // Along the edge's own direction, from one vertex of its level to the next; finer points lie on the segment between.
  int finest = int(level_ceil(curve.level));
  int step = n > finest ? 1 << (n - finest) : 1;
  vec3 low = curve.p0;
  for (int k = 0; k < 1 << n; k += step) {
    int end = k + step;
    vec3 high = end == 1 << n ? curve.p1 : edge_vertex(curve, bend, end, n, finest);
    for (int m = k == 0 ? 1 : k; m < end; ++m) {
      float x = float(m - k) / float(step);
      precise vec3 point = low * (1.0 - x) + high * x;
      int along = reversed ? (1 << n) - m : m;
      float t = float(along) / float(1 << n);
      vec3 w = side == 0 ? vec3(1.0 - t, t, 0.0) : side == 1 ? vec3(0.0, 1.0 - t, t) : vec3(t, 0.0, 1.0 - t);
      store_vertex(at + uint(along) - 1u, face, point, w);
    }
    low = high;
  }
}

void store_border(RefinedFace f, StoredFace face, Patch b, uvec3 halvings, uint at) {
  store_vertex(at, face, b.p[0], vec3(1.0, 0.0, 0.0));
  store_vertex(at + 1u, face, b.p[1], vec3(0.0, 1.0, 0.0));
  store_vertex(at + 2u, face, b.p[2], vec3(0.0, 0.0, 1.0));
  at += 3u;
  bvec3 reversed = notEqual(f.edges & kReversed, uvec3(0u));
  store_side(face, side_curve(b, f.edges, f.levels, 0), reversed.x, 0, int(halvings.x), at);
  at += (1u << halvings.x) - 1u;
  store_side(face, side_curve(b, f.edges, f.levels, 1), reversed.y, 1, int(halvings.y), at);
  at += (1u << halvings.y) - 1u;
  store_side(face, side_curve(b, f.edges, f.levels, 2), reversed.z, 2, int(halvings.z), at);
}

void store_inside(RefinedFace f, StoredFace face, Patch b, PatternDraw pattern, uint at) {
  PatchBend bend = patch_bend(b);
  for (uint v = pattern.border; v < pattern.vertices; ++v) {
    uint word = texelFetch(pattern_vertices, int(pattern.base_vertex + v)).x;
    int n = int(word >> 20 & 15u);
    int j = int(word & 1023u);
    int k = int(word >> 10 & 1023u);
    ivec3 ijk = ivec3((1 << n) - j - k, j, k);
    store_vertex(at + v, face, interior_point(b, bend, f.levels, ijk, n), vec3(ijk) / float(1 << n));
  }
}

/// All in one place, where triangles cover nothing.
void store_gap(PatternDraw pattern, uint at) {
  for (uint word = 3u * STORED_TEXELS * at; word < 3u * STORED_TEXELS * (at + pattern.vertices); ++word)
    stored_vertices[word] = 0u;
}

void main() {
  uint i = invocation_index();
  if (i >= selection_frame[43]) return;
  uint group = group_of_entry(i);
  GroupRange range = group_range(group);
  PatternDraw pattern = draws[(group + 2u) / 2u];
  uint n = i - range.start;
  uint at = range.vertex + n * pattern.vertices;
  if (n % pattern.batch == 0u) first_vertices[range.start + n / pattern.batch] = at;
  uint entry = entries[i];
  if (entry == kNoFace) {
    store_gap(pattern, at);
    return;
  }
  ivec3 corner_of = ivec3(entry >> 28 & 3u, entry >> 30, 0);
  corner_of.z = 3 - corner_of.x - corner_of.y;
  RefinedFace f = reordered(refined_face(entry & 0x0fffffffu), corner_of);
  StoredFace face = stored_face(f);
  Patch b = patch_of(f);
  uvec3 halvings = uvec3(pattern.halvings & 15u, pattern.halvings >> 4 & 15u, pattern.halvings >> 8);
  store_border(f, face, b, halvings, at);
  store_inside(f, face, b, pattern, at);
}
