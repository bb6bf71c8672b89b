// Vertices of refined faces, stored once for any number of passes (render/refinement/stored_surface.h), face by face, in world
// space. A vertex has STORED_TEXELS of three words: position; unless that is all, normal; texture coordinates and material,
// if the scene has either; and, if it has colours, two of these.

layout(std430, binding = 4) writeonly buffer StoredVertices { uint stored_vertices[]; };

void store_vector(uint word, vec3 v) {
  stored_vertices[word] = floatBitsToUint(v.x);
  stored_vertices[word + 1u] = floatBitsToUint(v.y);
  stored_vertices[word + 2u] = floatBitsToUint(v.z);
}

/// What is the same for all vertices of a face.
struct StoredFace {
  Placement placement;
#if STORED_TEXELS > 1
  NormalField normals;
  mat3x2 uvs;
  mat3x4 colors;
  uint material;
#endif
};

StoredFace stored_face(RefinedFace f) {
  StoredFace face;
  face.placement = placement_of(f.instance);
#if STORED_TEXELS > 1
  face.normals = normal_field_of(f);
  face.uvs = corner_uvs(f);
  face.colors = corner_colors(f);
  face.material = material_of(f.vertices.x);
#endif
  return face;
}

/// \param w  the point's weights on the face
void store_vertex(uint at, StoredFace face, vec3 point, vec3 w) {
  uint word = 3u * STORED_TEXELS * at;
  store_vector(word, to_world(face.placement, vec4(point, 1.0)));
#if STORED_TEXELS > 1
  store_vector(word + 3u, to_world(face.placement, vec4(interpolate_normal(face.normals, w), 0.0)));
  word += 6u;
#if defined(HAS_UVS) || defined(HAS_MATERIALS)
  vec2 uv = interpolate(face.uvs, w);
  stored_vertices[word] = floatBitsToUint(uv.x);
  stored_vertices[word + 1u] = floatBitsToUint(uv.y);
  stored_vertices[word + 2u] = face.material;  // not as a float, which might be one that devices change
  word += 3u;
#endif
#ifdef HAS_COLORS
  vec4 color = interpolate(face.colors, w);
  store_vector(word, color.rgb);
  store_vector(word + 3u, vec3(color.a, 0.0, 0.0));
#endif
#endif
}
