#version 450 core
// A segment's pixel: how much of it the line covers, and whether the line's own axis is hidden there.

#include "camera_block.glsl"
#include "srgb.glsl"

layout(location = 0) flat in vec3 window_a;
layout(location = 1) flat in vec3 window_b;
layout(location = 2) flat in vec3 srgb;

#if MULTISAMPLE
layout(binding = 0) uniform sampler2DMS depth;
#else
layout(binding = 0) uniform sampler2D depth;
#endif

uniform float half_width_px;

layout(location = 0) out vec4 color;

float eye_distance(float window_depth) {
  vec4 p = inverse_projection * vec4(0.0, 0.0, window_depth * 2.0 - 1.0, 1.0);
  return -p.z / p.w;
}

/// The farthest surface within a pixel of the axis. A line on an outline has the background beside it, one on a steep face has
/// that face's farther part: neither is hidden by its own faces. A line truly behind a surface finds it all around.
float farthest_near(vec2 at) {
  ivec2 middle = ivec2(floor(at));
  float farthest = 0.0;
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x) {
      ivec2 p = clamp(middle + ivec2(x, y), ivec2(0), ivec2(size_px) - 1);
      farthest = max(farthest, texelFetch(depth, p, 0).r);
    }
  }
  return farthest;
}

void main() {
  vec2 along = window_b.xy - window_a.xy;
  float squared = dot(along, along);
  float t = squared > 0.0 ? clamp(dot(gl_FragCoord.xy - window_a.xy, along) / squared, 0.0, 1.0) : 0.0;
  vec3 axis = mix(window_a, window_b, t);
  float coverage = clamp(half_width_px + 0.5 - length(gl_FragCoord.xy - axis.xy), 0.0, 1.0) * min(2.0 * half_width_px, 1.0);
  float line_distance = eye_distance(axis.z);
  float bias = 0.5 * pixel_size * (orthographic ? 1.0 : line_distance);
  if (coverage == 0.0 || line_distance - bias > eye_distance(farthest_near(axis.xy))) discard;
  color = vec4(srgb_to_linear(srgb), 1.0) * coverage;
}
