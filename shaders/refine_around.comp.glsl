#version 450 core
// Tells every edge the largest level of all edges of its faces: a nested pattern's border must match the finer neighbour.
// The words' lower halves are the edges' own and equal in all that are compared, so the largest word is the one wanted.

#include "refine_selection.glsl"

void main() {
  uint f = invocation_index();
  FaceRange range = face_range();
  if (!is_face(range, f)) return;
  uvec3 edges = texelFetch(face_edges, int(object_face(range, f))).xyz;
  if (edges.x == kInvalid) return;
  uvec3 at = edge_words_at(range, edges);
  uvec3 own = uvec3(level_own(levels[at.x]), level_own(levels[at.y]), level_own(levels[at.z]));
  uint largest = max(max(own.x, own.y), own.z);
  if (largest == 0u) return;
  atomicMax(levels[at.x], largest << 16 | own.x);
  atomicMax(levels[at.y], largest << 16 | own.y);
  atomicMax(levels[at.z], largest << 16 | own.z);
}
