#version 450 core
// How many triangles there would be with each of kSteps cuts taken from all levels. Sums are kept in two words, thousands
// of 4096 and the rest.

#include "refine_selection.glsl"
#include "refine_choice.glsl"
#include "refine_budget.glsl"

layout(std430, binding = 6) buffer Commands { uint commands[]; };
#include "refine_groups.glsl"

shared uint sums[kSteps];

void main() {
  if (gl_LocalInvocationIndex < kSteps) sums[gl_LocalInvocationIndex] = 0u;
  barrier();
  uint f = invocation_index();
  FaceRange range = face_range();
  if (is_face(range, f)) {
    uvec3 edges = texelFetch(face_edges, int(object_face(range, f))).xyz;
    if (edges.x != kInvalid) {
      uvec3 words = edge_words(range, edges);
      for (uint step = 0u; step < kSteps; ++step)
        atomicAdd(sums[step], draws[choose_pattern_at(words, cut_of(step)).base].triangles);
    }
  }
  barrier();
  if (gl_LocalInvocationIndex >= kSteps) return;
  uint sum = sums[gl_LocalInvocationIndex];
  atomicAdd(frame[kSums + 2u * gl_LocalInvocationIndex], sum >> 12);
  atomicAdd(frame[kSums + 2u * gl_LocalInvocationIndex + 1u], sum & 4095u);
}
