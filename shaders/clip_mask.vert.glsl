#version 450 core
// What only the stencil sees of a clipped model: its silhouette's triangles, or its faces.

#include "clip_space.glsl"
#include "clip_place.glsl"

layout(location = 0) in vec3 position;

void main() {
  gl_Position = to_clip_space(to_eye_space(to_world(vec4(position, 1.0))));
}
