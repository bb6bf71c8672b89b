#version 450 core
// Lights a clipped model's hull so that it looks like the original: the same light as face.frag.glsl, normals and colours
// baked from the original, and with a baked displacement the original's depth.
//   OBJECT_NORMALS  normals are a picture in the model's space; else the material's normal map turns the hull's
//   DETAIL_COLORS   colours are a picture of the asset's; else the material's
//   DISPLACEMENT    how far the original lies along the interpolated normal is a picture
//   MATTE           colours are multiplied by what the alpha channel holds by blending, alpha itself stays

#include "camera_block.glsl"
#include "light.glsl"
#include "material_table.glsl"
#include "normal_map.glsl"
#include "clip_place.glsl"

layout(location = 0) in vec3 at;
layout(location = 1) in vec3 shading_normal;
layout(location = 2) in vec2 texture_uv;
layout(location = 3) in vec4 tint;
layout(location = 4) flat in uint material;

layout(binding = 11) uniform sampler2D detail_normals;
layout(binding = 12) uniform sampler2D detail_colors;
layout(binding = 13) uniform sampler2D detail_displacement;
uniform vec2 displacement_range;  // what 0 and 1 stand for, in the model's units

layout(location = 0) out vec4 color;

/// In eye space, on the side of the surface that is seen.
vec3 hull_normal(Material m, vec3 to_eye) {
#ifdef OBJECT_NORMALS
  return normalize(mat3(rotation) * to_world(vec4(texture(detail_normals, texture_uv).xyz * 2.0 - 1.0, 0.0)));
#else
  float size = length(shading_normal);
  vec3 n = size > 0.0 ? shading_normal / size : to_eye;
  if (m.normal_layer >= 0) n = turn_normal(n, 1.0, mapped_normal(m, texture_uv), at, texture_uv);
  return n;
#endif
}

vec3 hull_color(Material m) {
#ifdef DETAIL_COLORS
  return texture(detail_colors, texture_uv).rgb * tint.rgb;
#else
  return base_color_of(m, texture_uv) * tint.rgb;
#endif
}

#ifdef DISPLACEMENT
/// The window's depth of the original below this point of the hull.
float original_depth() {
  float share = texture(detail_displacement, texture_uv).r;
  float size = length(vec3(to_world_rows[0].x, to_world_rows[1].x, to_world_rows[2].x));  // of the model's unit
  float away = size * mix(displacement_range.x, displacement_range.y, share);
  vec3 n = shading_normal / max(length(shading_normal), 1e-20);
  vec3 p = at + n * away;
  vec4 clip = projection * vec4(p, 1.0);
  return clamp(0.5 + 0.5 * clip.z / clip.w, 0.0, 0.99999994);
}
#endif

void main() {
  Material m = material_of(material);
  vec3 to_eye = orthographic ? vec3(0.0, 0.0, 1.0) : normalize(-at);
  vec3 n = hull_normal(m, to_eye);
  color = vec4(shade(n, to_eye, hull_color(m), m.metallic, m.roughness, world_up), 1.0);
#ifdef DISPLACEMENT
  gl_FragDepth = original_depth();
#endif
}
