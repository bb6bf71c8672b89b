#version 450 core
// A hull's corners, three a face, with what the march through its shell begins from.

#include "surface_vertex.glsl"
#include "clip_place.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 3) in vec4 color;
layout(location = 4) in uint material_id;

layout(location = 5) out vec3 model_at;  // the model's space
layout(location = 6) out vec2 weights;   // of the face's corners 1 and 2
layout(location = 7) flat out uint hull_face;

void main() {
  int corner = gl_VertexID % 3;
  model_at = position;
  weights = vec2(corner == 1, corner == 2);
  hull_face = uint(gl_VertexID) / 3u;
  emit_surface(to_world(vec4(position, 1.0)), to_world(vec4(normal, 0.0)), uv, color, material_id);
}
