#version 450 core
// A clipped model's hull as clip_hull.frag.glsl lights it, but of what the line of sight meets below the hull: it is followed
// through the shell, and where it leaves the hull again without meeting the surface, nothing is drawn, so that what lies
// behind shows (docs/interior-silhouettes.md). Needs OBJECT_NORMALS and a displacement.
//   DETAIL_COLORS   colours are a picture of the asset's; else the material's

#include "camera_block.glsl"
#include "clip_place.glsl"
#include "clip_shell.glsl"
#include "light.glsl"
#include "material_table.glsl"

layout(location = 0) in vec3 at;
layout(location = 1) in vec3 shading_normal;
layout(location = 2) in vec2 texture_uv;
layout(location = 3) in vec4 tint;
layout(location = 4) flat in uint material;
layout(location = 5) in vec3 model_at;
layout(location = 6) in vec2 weights;
layout(location = 7) flat in uint hull_face;

layout(binding = 11) uniform sampler2D detail_normals;
layout(binding = 12) uniform sampler2D detail_colors;
uniform vec4 model_eye;      // the viewer in the model's space; w = 0: the direction towards them
uniform float unit_px;        // the model's units a pixel: at distance 1 (perspective) or anywhere (orthographic)
uniform float texels_a_step;
uniform int march_steps;

layout(location = 0) out vec4 color;

void main() {
  Material m = material_of(material);
  vec3 base = base_color_of(m, texture_uv);
  vec2 texels = vec2(textureSize(detail_normals, 0));
  vec3 direction = model_eye.w == 0.0 ? -model_eye.xyz : model_at - model_eye.xyz;
  float away = model_eye.w == 0.0 ? 1.0 : length(direction);
  direction = normalize(direction);

  ShellPlace place = ShellPlace(hull_face, weights, 0.0);
  int end = march_shell(place, model_at, direction, 0.25 * unit_px * away, texels, texels_a_step, march_steps);
  if (end == kHullLeft) discard;

  ShellFrame frame = shell_frame(shell_faces[place.face], place);
  vec3 seen = mat3(rotation) * (to_world(vec4(frame.at, 1.0)) - eye);
  vec4 clip = projection * vec4(seen, 1.0);
  gl_FragDepth = clamp(0.5 + 0.5 * clip.z / clip.w, 0.0, 0.99999994);
  vec3 to_eye = orthographic ? vec3(0.0, 0.0, 1.0) : normalize(-seen);
  vec3 n = textureLod(detail_normals, frame.uv, 0.0).xyz * 2.0 - 1.0;
  n = normalize(mat3(rotation) * to_world(vec4(n, 0.0)));
#ifdef DETAIL_COLORS
  base = textureLod(detail_colors, frame.uv, 0.0).rgb;
#endif
  color = vec4(shade(n, to_eye, base * tint.rgb, m.metallic, m.roughness, world_up), 1.0);
}
