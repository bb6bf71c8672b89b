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

void store_border(RefinedFace f, StoredFace face, Patch patch_, ivec3 corner_of, uvec3 halvings, uint at) {
  for (int b = 0; b < 3; ++b) {
    vec3 w = vec3(0.0);
    w[corner_of[b]] = 1.0;
    store_vertex(at + uint(b), face, patch_.p[corner_of[b]], w);
  }
  at += 3u;
  for (int b = 0; b < 3; ++b) {
    int from = corner_of[b];
    int to = corner_of[b == 2 ? 0 : b + 1];
    bool along = to == (from == 2 ? 0 : from + 1);  // the pattern's side runs as the face's does
    int c = along ? from : to;
    bool reversed = (f.edges[c] & kReversed) != 0u;
    vec3 p0 = patch_.p[along ? from : to], p1 = patch_.p[along ? to : from];
    vec3 c0 = patch_.c[2 * c], c1 = patch_.c[2 * c + 1];
    EdgeCurve curve = reversed ? EdgeCurve(p1, c1, c0, p0, f.levels[c]) : EdgeCurve(p0, c0, c1, p1, f.levels[c]);
    int n = int(halvings[b]);
    bool forward = along != reversed;
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
        float weight = float(m) / float(1 << n);
        vec3 w = vec3(0.0);
        w[to] = forward ? weight : 1.0 - weight;
        w[from] = 1.0 - w[to];
        store_vertex(at + uint(forward ? m : (1 << n) - m) - 1u, face, point, w);
      }
      low = high;
    }
    at += uint((1 << n) - 1);
  }
}

void store_inside(RefinedFace f, StoredFace face, Patch patch_, ivec3 corner_of, PatternDraw pattern, uint at) {
  PatchBend bend = patch_bend(patch_);
  for (uint v = pattern.border; v < pattern.vertices; ++v) {
    uint word = texelFetch(pattern_vertices, int(pattern.base_vertex + v)).x;
    int n = int(word >> 20 & 15u);
    int j = int(word & 1023u);
    int k = int(word >> 10 & 1023u);
    ivec3 ijk;
    ijk[corner_of.x] = (1 << n) - j - k;
    ijk[corner_of.y] = j;
    ijk[corner_of.z] = k;
    store_vertex(at + v, face, interior_point(patch_, bend, f.levels, ijk, n), vec3(ijk) / float(1 << n));
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
  RefinedFace f = refined_face(entry & 0x0fffffffu);
  StoredFace face = stored_face(f);
  Patch patch_ = patch_of(f);
  store_border(f, face, patch_, corner_of, uvec3(pattern.halvings & 15u, pattern.halvings >> 4 & 15u, pattern.halvings >> 8), at);
  store_inside(f, face, patch_, corner_of, pattern, at);
}
