#version 450 core
// A stored vertex of a refined face (refine_stored.glsl).

#include "refine_emit.glsl"

layout(binding = 0) uniform usamplerBuffer stored_vertices;
layout(location = 0) in uint first_vertex;  // of the instance's faces

vec3 stored_vector(int texel) { return uintBitsToFloat(texelFetch(stored_vertices, texel).xyz); }

void main() {
  int at = STORED_TEXELS * (int(first_vertex) + gl_VertexID);
  vec3 position = stored_vector(at);
#ifdef CAPTURED
  captured_position = position;
  captured_source = uvec2(0xffffffffu, first_vertex + uint(gl_VertexID));
#endif
#ifdef POSITIONS_ONLY
  place_vertex(position);
#else
  vec3 normal = stored_vector(at + 1);
  at += 2;
  vec2 uv = vec2(0.0);
  vec4 color = vec4(1.0);
  uint material_id = 0u;
#if defined(HAS_UVS) || defined(HAS_MATERIALS)
  uvec3 words = texelFetch(stored_vertices, at++).xyz;
  uv = uintBitsToFloat(words.xy);
  material_id = words.z;
#endif
#ifdef HAS_COLORS
  color = vec4(stored_vector(at), stored_vector(at + 1).x);
#endif
  emit_surface(position, normal, uv, color, material_id);
#endif
}
