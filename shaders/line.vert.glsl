#version 450 core
// A segment as a quad on the screen, as wide as asked and a pixel more on every side for its soft rim. Draw 4 vertices
// (a strip) an instance.

#include "camera_block.glsl"

layout(location = 0) in vec3 a;
layout(location = 1) in vec3 b;
layout(location = 2) in vec3 line_color;

uniform float half_width_px;

layout(location = 0) flat out vec3 window_a;  // pixels, and depth 0 to 1
layout(location = 1) flat out vec3 window_b;
layout(location = 2) flat out vec3 srgb;

vec3 to_window(vec3 p) {
  vec4 clip = projection * vec4(p, 1.0);
  vec3 ndc = clip.xyz / clip.w;
  return vec3((ndc.xy * 0.5 + 0.5) * size_px, ndc.z * 0.5 + 0.5);
}

void main() {
  vec3 p = (rotation * vec4(a - eye, 0.0)).xyz;
  vec3 q = (rotation * vec4(b - eye, 0.0)).xyz;
  srgb = line_color;
  // What lies behind the near plane has no place on the screen: cut it off before the division.
  bool p_behind = -p.z < near_distance;
  bool q_behind = -q.z < near_distance;
  if (p_behind && q_behind) {
    window_a = window_b = vec3(0.0);
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    return;
  }
  if (p_behind || q_behind) {
    vec3 cut = p + (q - p) * ((-near_distance - p.z) / (q.z - p.z));
    if (p_behind) p = cut;
    else q = cut;
  }
  window_a = to_window(p);
  window_b = to_window(q);
  vec2 along = window_b.xy - window_a.xy;
  float len = length(along);
  along = len > 1e-6 ? along / len : vec2(1.0, 0.0);
  vec2 across = vec2(-along.y, along.x);
  float reach = half_width_px + 1.0;
  bool at_end = (gl_VertexID & 2) != 0;
  vec2 corner = (at_end ? window_b.xy + along * reach : window_a.xy - along * reach) +
                across * ((gl_VertexID & 1) != 0 ? reach : -reach);
  gl_Position = vec4(corner / size_px * 2.0 - 1.0, 0.0, 1.0);
}
