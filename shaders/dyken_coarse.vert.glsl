#version 450 core
// A vertex of the unrefined triangles: the triangle's index is in the stream, and tagged ones collapse (Dyken et al. 2008, section
// 6.3). Of a deforming mesh, with DEFORMING, the stream holds nothing else, and the vertex is fetched.

#include "refine_scene.glsl"
#include "refine_emit.glsl"

layout(binding = 11) uniform usamplerBuffer tagged_faces;

layout(location = 0) in uint face;
#ifndef DEFORMING
layout(location = 1) in vec3 position;
layout(location = 2) in vec3 normal;
#endif

void main() {
  if (texelFetch(tagged_faces, int(face)).x != 0u) {
#ifdef CAPTURED
    captured_position = vec3(0.0);
    captured_source = uvec2(0xffffffffu);
#endif
    collapse_vertex();
    return;
  }
  uint v = texelFetch(face_vertices, int(face))[gl_VertexID % 3];
#ifdef DEFORMING
  vec3 position = position_of(v);
  vec3 normal = normal_of(v);
#endif
#ifdef CAPTURED
  captured_position = position;
  captured_source = uvec2(0xffffffffu, v);
#endif
  Placement placement = placement_of(0u);
  vec3 world = to_world(placement, vec4(position, 1.0));
#ifdef POSITIONS_ONLY
  place_vertex(world);
#else
  emit_surface(world, to_world(placement, vec4(normal, 0.0)), uv_of(v), color_of(v), material_of(v));
#endif
}
