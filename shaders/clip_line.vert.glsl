#version 450 core
// A segment of a clipped model's silhouette as a quad on the screen, a pixel wider on every side for its soft rim. Draw 4
// vertices (a strip) an instance.

#include "clip_space.glsl"
#include "clip_place.glsl"

layout(location = 0) in vec3 from;
layout(location = 1) in vec3 to;

uniform float half_width_px;

layout(location = 0) flat out vec2 window_a;  // pixels
layout(location = 1) flat out vec2 window_b;

vec2 to_window(vec3 p) {
  vec4 clip = to_clip_space(p);
  return (clip.xy / clip.w * 0.5 + 0.5) * size_px;
}

void main() {
  vec3 p = to_eye_space(to_world(vec4(from, 1.0)));
  vec3 q = to_eye_space(to_world(vec4(to, 1.0)));
  // What lies behind the viewer has no place on the screen: cut it off before the division. A parallel view has no behind.
  float cut_at = orthographic ? -1e30 : 0.01 * near_distance;
  bool p_behind = -p.z < cut_at;
  bool q_behind = -q.z < cut_at;
  window_a = window_b = vec2(0.0);
  gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  if (p_behind && q_behind) return;
  if (p_behind || q_behind) {
    vec3 cut = p + (q - p) * ((-cut_at - p.z) / (q.z - p.z));
    if (p_behind) p = cut;
    else q = cut;
  }
  window_a = to_window(p);
  window_b = to_window(q);
  vec2 along = window_b - window_a;
  float len = length(along);
  along = len > 1e-6 ? along / len : vec2(1.0, 0.0);
  vec2 across = vec2(-along.y, along.x);
  float reach = half_width_px + 1.0;
  bool at_end = (gl_VertexID & 2) != 0;
  vec2 corner = (at_end ? window_b + along * reach : window_a - along * reach) +
                across * ((gl_VertexID & 1) != 0 ? reach : -reach);
  gl_Position = vec4(corner / size_px * 2.0 - 1.0, 0.0, 1.0);
}
