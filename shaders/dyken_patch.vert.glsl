#version 450 core
// A vertex of the pre-tessellated patch P_m on the surface of one refined triangle, whose coefficients are uniforms: basis functions,
// sampled at two levels, come from a texture and are blended (Dyken et al. 2008, section 6.4, equation (14)). TEN: ten functions in
// three texels; PACKED: eight in one texel; else eight in two. Without BLENDED, levels are rounded up.
// render/refinement/published/basis_table.h has the layout.

#include "refine_scene.glsl"
#include "refine_levels.glsl"
#include "refine_surface.glsl"
#include "refine_emit.glsl"

layout(location = 0) in uint patch_vertex;  // j and k, 10 bits each, in segments of 2^-m

layout(binding = 11) uniform sampler2D basis;

/// The corners, each with the level of the side that begins there; the inner points of sides 0, 1, 2 in pairs, the first with the
/// face, the second with m; the corners' normals; the center (TEN). Floats by their bits.
uniform uvec4 coefficients[13];
uniform int table_level;  // M, that of the table's vertices

#ifdef TEN
const int kFunctions = 10;
const int kTexelRows = 3;
#else
const int kFunctions = 9;
#ifdef PACKED
const int kTexelRows = 1;
const float kWhole = 4094.0;  // what stands for 1
#else
const int kTexelRows = 2;
const float kWhole = 1.0;
#endif
#endif

/// Of the corners, then of the inner points of the sides, then of the center.
struct Weights {
  float of[kFunctions];
};

Weights sampled_weights(ivec2 vertex, int level) {
  ivec2 at = ivec2(vertex.x * (table_level + 1) + level, vertex.y * kTexelRows);
#ifdef PACKED
  vec4 both = texelFetch(basis, at, 0);
  vec4 first = floor(both);
  vec4 second = (both - first) * 4096.0;
#else
  vec4 first = texelFetch(basis, at, 0);
  vec4 second = texelFetch(basis, at + ivec2(0, 1), 0);
#endif
  Weights f;
  f.of[1] = first.x;
  f.of[2] = first.y;
  f.of[3] = first.z;
  f.of[4] = first.w;
  f.of[5] = second.x;
  f.of[6] = second.y;
  f.of[7] = second.z;
  f.of[8] = second.w;
#ifdef TEN
  vec2 third = texelFetch(basis, at + ivec2(0, 2), 0).xy;
  f.of[0] = third.x;
  f.of[9] = third.y;
#else
  // Multiples of one small unit and no more than 1 in all: no sum rounds, so this is what the table would have held.
  f.of[0] = kWhole - (((first.x + first.y) + (first.z + first.w)) + ((second.x + second.y) + (second.z + second.w)));
#endif
  return f;
}

Weights weights_at(ivec2 vertex, uint level) {
#ifdef BLENDED
  int low = int(level >> 12);
  Weights f = sampled_weights(vertex, low);
  Weights g = sampled_weights(vertex, min(low + 1, table_level));
  float share = float(level & (kLevelOne - 1u)) * kLevelUnit;
  for (int i = 0; i < kFunctions; ++i) {
    precise float blended = f.of[i] * (1.0 - share) + g.of[i] * share;
    f.of[i] = blended;
  }
#else
  Weights f = sampled_weights(vertex, int(level_ceil(level)));
#endif
#ifdef PACKED
  for (int i = 0; i < kFunctions; ++i) {
    precise float scaled = f.of[i] * (1.0 / kWhole);
    f.of[i] = scaled;
  }
#endif
  return f;
}

vec3 coefficient(int i) {
  return uintBitsToFloat(coefficients[i].xyz);
}

uint side_level(int side) {
  return coefficients[side].w;
}

/// Only the four functions of the side are not 0 there. The sum reads the same from both ends, so that both faces find the same
/// bits.
vec3 side_point(int side, Weights f) {
  int next = side == 2 ? 0 : side + 1;
  int beside = 3 + 2 * side;
  vec3 p0 = coefficient(side), c0 = coefficient(beside), c1 = coefficient(beside + 1), p1 = coefficient(next);
  precise vec3 p = (f.of[side] * p0 + f.of[beside] * c0) + (f.of[beside + 1] * c1 + f.of[next] * p1);
  return p;
}

vec3 inner_point(Weights f) {
  vec3 p = vec3(0.0);
  for (int i = 0; i < 9; ++i)
    p += f.of[i] * coefficient(i);
#ifdef TEN
  p += f.of[9] * coefficient(12);
#endif
  return p;
}

/// \param ijk  weights in segments of 2^-m
vec3 point_at(ivec3 ijk, int m) {
  int whole = 1 << m;
  if (ijk.x == whole) return coefficient(0);
  if (ijk.y == whole) return coefficient(1);
  if (ijk.z == whole) return coefficient(2);
  ivec2 vertex = ijk.yz << (table_level - m);
  if (ijk.x != 0 && ijk.y != 0 && ijk.z != 0)
    return inner_point(weights_at(vertex, max(max(side_level(0), side_level(1)), side_level(2))));
  int side = ijk.z == 0 ? 0 : ijk.x == 0 ? 1 : 2;
  return side_point(side, weights_at(vertex, side_level(side)));
}

void main() {
  int m = int(coefficients[4].w);
  int j = int(patch_vertex & 1023u);
  int k = int(patch_vertex >> 10);
  ivec3 ijk = ivec3((1 << m) - j - k, j, k);
  uint face = coefficients[3].w;
  vec3 point = point_at(ijk, m);
  Placement placement = placement_of(0u);
  vec3 world = to_world(placement, vec4(point, 1.0));
#ifdef CAPTURED
  captured_position = point;
  captured_source = uvec2(face, uint(j) | uint(k) << 12 | uint(m) << 24);
#endif
#ifdef POSITIONS_ONLY
  place_vertex(world);
#else
  vec3 w = vec3(ijk) / float(1 << m);
  uvec3 v = texelFetch(face_vertices, int(face)).xyz;
  vec3 p[3] = vec3[3](coefficient(0), coefficient(1), coefficient(2));
  vec3 n[3] = vec3[3](coefficient(9), coefficient(10), coefficient(11));
  emit_surface(world, to_world(placement, vec4(interpolate_normal(normal_field(p, n), w), 0.0)),
               uv_of(v.x) * w.x + uv_of(v.y) * w.y + uv_of(v.z) * w.z,
               color_of(v.x) * w.x + color_of(v.y) * w.y + color_of(v.z) * w.z, material_of(v.x));
#endif
}
