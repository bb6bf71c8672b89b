#version 450 core
// Lists unrefined triangles and refined faces, each in ascending order.

#include "refine_selection.glsl"

const uint kWords = kWorkgroupSize / 32u;
shared uint flags[2][kWords];  // which of the block's faces are not refined, which are

/// How many of the block's faces before this one are of its kind.
uint rank_of(uint kind) {
  uint t = gl_LocalInvocationIndex;
  uint rank = bitCount(flags[kind][t / 32u] & ((1u << (t % 32u)) - 1u));
  for (uint word = 0u; word < t / 32u; ++word)
    rank += bitCount(flags[kind][word]);
  return rank;
}

void main() {
  uint t = gl_LocalInvocationIndex;
  if (t < 2u * kWords) flags[t / kWords][t % kWords] = 0u;
  barrier();
  uint f = invocation_index();
  uint key = f < face_capacity ? keys[f] : kCulled;
  uint kind = key == 0u ? 0u : 1u;
  if (key != kCulled) atomicOr(flags[kind][t / 32u], 1u << (t % 32u));
  barrier();
  if (key == kCulled) return;
  uint rank = rank_of(kind);
  uvec2 first = blocks[workgroup_index()];
  if (key != 0u) {
    uint slot = refined_slot(first.y + rank);
    lists[slot] = f;
    lists[slot + 1u] = key;
    return;
  }
  FaceRange range = face_range();
  uvec3 v = texelFetch(face_vertices, int(object_face(range, f))).xyz - range.edges.w + range.faces.w;
  uint at = 3u * (first.x + rank);
  lists[at] = v.x;
  lists[at + 1u] = v.y;
  lists[at + 2u] = v.z;
}
