#version 450 core
// A vertex of a clipped model's hull, or of the original in its place, moved into the world.

#include "surface_vertex.glsl"
#include "clip_place.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 3) in vec4 color;
layout(location = 4) in uint material_id;

layout(location = 5) out vec3 model_at;      // the model's space
layout(location = 6) out vec3 model_normal;

void main() {
  model_at = position;
  model_normal = normal;
  emit_surface(to_world(vec4(position, 1.0)), to_world(vec4(normal, 0.0)), uv, color, material_id);
}
