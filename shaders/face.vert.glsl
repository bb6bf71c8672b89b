#version 450 core
// A mesh's vertices as they are.

#include "surface_vertex.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 3) in vec4 color;
layout(location = 4) in uint material_id;

void main() {
  emit_surface(position, normal, uv, color, material_id);
}
