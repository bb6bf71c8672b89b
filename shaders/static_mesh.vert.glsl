#version 450 core
// A vertex of a mesh that was refined before, in a buffer; drawn an instance of an object and a material at a time.

#include "refine_scene.glsl"
#include "refine_emit.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 3) in vec4 color;
layout(location = 4) in uvec2 instance_material;

void main() {
  vec3 place = to_world(instance_material.x, vec4(position, 1.0));
#ifdef CAPTURED
  captured_position = position;
  captured_source = uvec2(0xffffffffu, uint(gl_VertexID));
#endif
#ifdef POSITIONS_ONLY
  place_vertex(place);
#else
  emit_surface(place, to_world(instance_material.x, vec4(normal, 0.0)), uv, color, instance_material.y);
#endif
}
