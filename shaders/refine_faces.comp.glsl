#version 450 core
// Chooses the pattern of every face, and counts in each block how many are refined and how many are not.

#include "refine_selection.glsl"
#include "refine_choice.glsl"

shared uint counted[2];

uint key_of(FaceRange range, uint f) {
  uvec3 edges = texelFetch(face_edges, int(object_face(range, f))).xyz;
  if (edges.x == kInvalid) return kCulled;
  PatternChoice choice = choose_pattern_at(edge_words(range, edges), frame[0]);
  if (choice.base == 0u) return 0u;
  return choice.base | (choice.mirrored ? 1u << 12 : 0u) | choice.corners << 13;
}

void main() {
  if (gl_LocalInvocationIndex < 2u) counted[gl_LocalInvocationIndex] = 0u;
  barrier();
  uint f = invocation_index();
  FaceRange range = face_range();
  uint key = is_face(range, f) ? key_of(range, f) : kCulled;
  if (f < face_capacity) keys[f] = key;
  if (key != kCulled) atomicAdd(counted[key == 0u ? 0 : 1], 1u);
  barrier();
  if (gl_LocalInvocationIndex == 0u && f < face_capacity) blocks[workgroup_index()] = uvec2(counted[0], counted[1]);
}
