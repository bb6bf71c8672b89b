#version 450 core
// The one stage that lights surfaces, whatever placed their vertices (surface_vertex.glsl); with thin lines along the edges
// when WIREFRAME is defined.

#include "camera_block.glsl"
#include "light.glsl"
#include "material_table.glsl"
#include "normal_map.glsl"

layout(location = 0) in vec3 at;
layout(location = 1) in vec3 shading_normal;
layout(location = 2) in vec2 texture_uv;
layout(location = 3) in vec4 tint;
layout(location = 4) flat in uint material;
#ifdef WIREFRAME
layout(location = 5) in vec3 barycentric;
#endif

uniform bool flat_normals;  // the faces' own, whatever the vertices say
uniform bool draw_faces;

layout(location = 0) out vec4 color;

/// Towards the viewer from the face's plane; for the rim of a face so thin that derivatives vanish, the view itself.
vec3 face_normal(vec3 to_eye) {
  vec3 n = cross(dFdx(at), dFdy(at));
  float size = length(n);
  if (size == 0.0) return to_eye;
  n /= size;
  return dot(n, to_eye) < 0.0 ? -n : n;
}

#ifdef WIREFRAME
const float kWireWidth = 1.0;  // pixels
const vec3 kWireColor = vec3(0.012, 0.016, 0.026);

/// How much of the pixel an edge's line covers. Where a whole triangle is no wider than a few pixels, lines fade, lest dense
/// meshes turn black.
float wire_coverage() {
  vec3 slope = max(vec3(length(vec2(dFdx(barycentric.x), dFdy(barycentric.x))),
                        length(vec2(dFdx(barycentric.y), dFdy(barycentric.y))),
                        length(vec2(dFdx(barycentric.z), dFdy(barycentric.z)))), vec3(1e-9));
  vec3 distance_px = barycentric / slope;
  float nearest = min(min(distance_px.x, distance_px.y), distance_px.z);
  float line = clamp(0.5 * kWireWidth + 0.5 - nearest, 0.0, 1.0);
  float widest_px = 1.0 / min(min(slope.x, slope.y), slope.z);
  return line * smoothstep(1.5, 8.0, widest_px);
}
#endif

void main() {
  Material m = material_of(material);
  vec3 to_eye = orthographic ? vec3(0.0, 0.0, 1.0) : normalize(-at);
  vec3 n = face_normal(to_eye);
  float front = gl_FrontFacing ? 1.0 : -1.0;
  float size = length(shading_normal);
  if (!flat_normals && size > 0.0) {
    vec3 smooth_normal = shading_normal / size;
    front = dot(smooth_normal, n) < 0.0 ? -1.0 : 1.0;
    n = front * smooth_normal;
  }
  if (m.normal_layer >= 0) n = turn_normal(n, front, mapped_normal(m, texture_uv), at, texture_uv);
  vec3 base = base_color_of(m, texture_uv) * tint.rgb;
  vec3 lit = shade(n, to_eye, base, m.metallic, m.roughness, world_up);
#ifdef WIREFRAME
  float wire = wire_coverage();
  if (draw_faces) {
    color = vec4(mix(lit, kWireColor, 0.75 * wire), 1.0);
  } else {
    color = vec4(kWireColor, 1.0) * wire;
  }
#else
  color = vec4(lit, 1.0);
#endif
}
