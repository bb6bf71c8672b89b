// What only passes over edges read of a refinement scene, beside refine_scene.glsl.

layout(binding = 11) uniform usamplerBuffer edge_blocks;    // the instance of each 256 edges
layout(binding = 12) uniform usamplerBuffer edge_faces;     // two sides: face * 4 + side; the first runs forward where one does
layout(binding = 13) uniform usamplerBuffer face_normals;

const uint kManyFaces = 0xfffffffeu;  // of the second side: a non-manifold edge; kInvalid: a boundary

/// The ends of an edge in its own order, v[0] and v[1], as vertices of the face on the given side.
uvec2 edge_ends(uint edge, uint side) {
  int face = int(side >> 2);
  uint c = side & 3u;
  uvec3 v = texelFetch(face_vertices, face).xyz;
  uvec2 ends = uvec2(v[c], v[c == 2u ? 0u : c + 1u]);
  return (texelFetch(face_edges, face)[c] & kReversed) != 0u ? ends.yx : ends;
}

vec3 face_normal_of(uint side) {
  return uintBitsToFloat(texelFetch(face_normals, int(side >> 2)).xyz);
}
