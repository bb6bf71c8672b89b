#version 450 core
// A vertex of an unrefined triangle; the index names vertex and instance.

#include "refine_scene.glsl"
#include "refine_emit.glsl"

void main() {
  uint instance = texelFetch(vertex_blocks, gl_VertexID >> 8).x;
  uint v = uint(gl_VertexID) - instance_faces(instance).w + instance_edges(instance).w;
  Placement placement = placement_of(instance);
  vec3 position = to_world(placement, vec4(position_of(v), 1.0));
#ifdef CAPTURED
  captured_position = position_of(v);
  captured_source = uvec2(0xffffffffu, v);
#endif
#ifdef POSITIONS_ONLY
  place_vertex(position);
#else
  emit_surface(position, to_world(placement, vec4(normal_of(v), 0.0)), uv_of(v), color_of(v), material_of(v));
#endif
}
