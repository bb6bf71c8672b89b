#version 450 core
// Averages a pixel's samples (premultiplied, linear), lays them over the background and gives straight alpha in sRGB,
// rows from the top. MULTISAMPLE is the number of samples, 0 for a plain texture.

#include "srgb.glsl"

#if MULTISAMPLE
layout(binding = 0) uniform sampler2DMS picture;
#else
layout(binding = 0) uniform sampler2D picture;
#endif

uniform vec4 background;  // sRGB, straight alpha
uniform int height;

layout(location = 0) out vec4 color;

vec4 load(ivec2 at) {
#if MULTISAMPLE
  vec4 sum = vec4(0.0);
  for (int i = 0; i < MULTISAMPLE; ++i) sum += texelFetch(picture, at, i);
  return sum / float(MULTISAMPLE);
#else
  return texelFetch(picture, at, 0);
#endif
}

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  vec4 front = load(ivec2(at.x, height - 1 - at.y));
  if (front.a == 0.0) {
    color = background.a == 0.0 ? vec4(0.0) : background;
    return;
  }
  vec4 behind = vec4(srgb_to_linear(background.rgb), 1.0) * background.a;
  vec4 sum = front + (1.0 - front.a) * behind;
  color = vec4(linear_to_srgb(min(sum.rgb / sum.a, vec3(1.0))), sum.a);
}
