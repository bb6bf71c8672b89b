#version 450 core
// How much of a pixel a segment of the silhouette covers, as alpha.

layout(location = 0) flat in vec2 window_a;
layout(location = 1) flat in vec2 window_b;

uniform float half_width_px;

layout(location = 0) out vec4 color;

void main() {
  vec2 along = window_b - window_a;
  float squared = dot(along, along);
  float t = squared > 0.0 ? clamp(dot(gl_FragCoord.xy - window_a, along) / squared, 0.0, 1.0) : 0.0;
  float coverage = clamp(half_width_px + 0.5 - length(gl_FragCoord.xy - mix(window_a, window_b, t)), 0.0, 1.0);
  if (coverage == 0.0) discard;
  color = vec4(0.0, 0.0, 0.0, coverage);
}
