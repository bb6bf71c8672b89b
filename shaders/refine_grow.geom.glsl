#version 450 core
// A pass of dynamic mesh refinement (Lorenz and Döllner 2008): every triangle of the last refined mesh writes its share of the next
// one's, copies from the pattern that its face asks for now, at most MOST of them. Of n triangles that a face has, triangle t writes
// t, t + n, t + 2n ...: none when the pattern has fewer.

#include "refine_vertex.glsl"
#include "refine_choice.glsl"
#include "refine_pattern_vertex.glsl"

layout(triangles) in;
layout(triangle_strip, max_vertices = 3 * MOST) out;

layout(binding = 16) uniform usamplerBuffer pattern_ranges;     // first vertex, how many, first triangle, how many
layout(binding = 17) uniform usamplerBuffer pattern_vertices;   // refine_pattern_vertex.glsl
layout(binding = 18) uniform usamplerBuffer pattern_triangles;  // of vertices counted from the pattern's first

flat in uvec3 corner[];
out uvec3 next_corner;  // refine_stream.glsl

void emit_corner(uint face, uint word, uint corners, uint which) {
  ivec3 ijk = weights_on_face(pattern_weights(word), corners);
  next_corner = uvec3(face, uint(ijk.y) | uint(ijk.z) << 10 | (word & 0xf00000u), which);
  EmitVertex();
}

void main() {
  uint face = corner[0].x;
  uint count = (corner[0].z >> 16) + 1u;
  PatternChoice choice = choose_pattern(0u, (refined_face(face).levels + (kLevelOne - 1u)) >> 12u);
  uvec4 range = texelFetch(pattern_ranges, int(choice.base));
  uint next_count = min(range.w, count * uint(MOST));
  for (uint t = corner[0].z & 0xffffu; t < next_count; t += count) {
    uvec3 triangle = texelFetch(pattern_triangles, int(range.z + t)).xyz;
    if (choice.mirrored) triangle = triangle.xzy;
    for (int c = 0; c < 3; ++c) {
      uint word = texelFetch(pattern_vertices, int(range.x + triangle[c])).x;
      emit_corner(face, word, choice.corners, t | (next_count - 1u) << 16);
    }
    EndPrimitive();
  }
}
