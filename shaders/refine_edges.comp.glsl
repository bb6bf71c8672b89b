#version 450 core
// The level of every edge of every instance, once an edge: the twin of edge_levels() (refine/levels.h). CRITERION is that of
// render/refinement/edge_levels.cpp.

#include "compute.glsl"
#include "refine_scene.glsl"
#include "refine_edge_tables.glsl"
#include "refine_levels.glsl"
#include "precise_log2.glsl"
#include "silhouetteness.glsl"

layout(std430, binding = 0) writeonly buffer Levels { uint levels[]; };
layout(std430, binding = 1) readonly buffer Shares { float shares[]; };  // an edge of the objects; criteria that do not depend on the eye

uniform uint max_level;
uniform float tolerance_px;        // 0: levels are max_level times the share
uniform float wedge_sine_cosine;   // sin φ cos φ
uniform float wedge_sine_squared;  // sin²φ
uniform bool wedge_quarter;
uniform vec2 distances;            // near and far; 0 0: the instance's own


struct EdgeView {
  dvec3 p, q;
  dvec3 eye;
  bool orthographic;
};

dvec3 exact_point(uvec3 bits) {
  return dvec3(exact_value(bits.x), exact_value(bits.y), exact_value(bits.z));
}

double length_of(dvec3 d) {
  precise double squared = d.x * d.x + d.y * d.y + d.z * d.z;
  return sqrt(squared);
}

float beta_of(vec3 ns, vec3 nt) {
  if (wedge_quarter) return 0.25;
  precise float cosine = ns.x * nt.x + ns.y * nt.y + ns.z * nt.z;
  precise vec3 cross_product = vec3(ns.y * nt.z - nt.y * ns.z, ns.z * nt.x - nt.z * ns.x, ns.x * nt.y - nt.x * ns.y);
  precise float squared = cross_product.x * cross_product.x + cross_product.y * cross_product.y + cross_product.z * cross_product.z;
  precise float beta = wedge_sine_cosine * sqrt(squared) + wedge_sine_squared * cosine;
  return max(beta, 1e-6);
}

float silhouette_share(EdgeView view, uvec2 sides) {
  if (sides.y >= kManyFaces) return 1.0;
  vec3 ns = face_normal_of(sides.x);
  vec3 nt = face_normal_of(sides.y);
  if (ns == vec3(0.0) || nt == vec3(0.0)) return 1.0;
  vec3 middle = vec3(0.5lf * (view.p + view.q));
  vec3 d = view.orthographic ? unit_direction(view.eye, dvec3(0.0lf)) : unit_direction(view.eye, dvec3(middle));
  return silhouetteness(silhouette_product(d, ns, nt), beta_of(ns, nt));
}

float distance_share(EdgeView view, vec2 near_far) {
  double at = length_of(0.5lf * (view.p + view.q) - view.eye);
  if (at <= double(near_far.x)) return 1.0;
  if (at >= double(near_far.y)) return 0.0;
  return precise_log2(float(double(near_far.y) / at)) / precise_log2(near_far.y / near_far.x);
}

/// How far the picture of the edge's curve may stray from its chord, in pixels; negative: the eye is on the edge.
float deviation_px(EdgeView view, uint edge, float pixels_per_unit) {
  dvec3 sight = view.orthographic ? view.eye : view.eye - 0.5lf * (view.p + view.q);
  double far = length_of(sight);
  if (!(far > 0.0lf)) return -1.0;
  sight /= far;
  dvec3 a = exact_point(texelFetch(curves, int(2u * edge)).xyz) - (2.0lf * view.p + view.q) / 3.0lf;
  dvec3 b = exact_point(texelFetch(curves, int(2u * edge + 1u)).xyz) - (view.p + 2.0lf * view.q) / 3.0lf;
  a -= dot(a, sight) * sight;
  b -= dot(b, sight) * sight;
  double largest = 0.75lf * max(length_of(b - 2.0lf * a), length_of(a - 2.0lf * b));
  return float(largest * double(pixels_per_unit) / (view.orthographic ? 1.0lf : far));
}

float needed_level(EdgeView view, uint edge, float pixels_per_unit) {
  float stray = deviation_px(view, edge, pixels_per_unit);
  if (stray < 0.0) return float(max_level);
  float ratio = stray / tolerance_px;
  return ratio <= 1.0 ? 0.0 : ratio > 1e30 ? float(max_level) : min(0.5 * precise_log2(ratio), float(max_level));
}

void main() {
  uint e = invocation_index();
  uint instance = texelFetch(edge_blocks, int(workgroup_index())).x;
  uvec4 range = instance_edges(instance);
  if (e - range.x >= range.z) return;  // also past the last instance's edges
  uint edge = range.y + (e - range.x);
  uvec2 sides = texelFetch(edge_faces, int(edge)).xy;
  uvec2 ends = edge_ends(edge, sides.x);
  uvec4 eye = instance_texel(instance, 3);
  vec4 view_numbers = uintBitsToFloat(instance_texel(instance, 6));
  EdgeView view = EdgeView(exact_point(texelFetch(positions, int(ends.x)).xyz),
                           exact_point(texelFetch(positions, int(ends.y)).xyz), exact_point(eye.xyz), eye.w != 0u);
  float share = 1.0;
#if CRITERION == 0
  share = silhouette_share(view, sides);
#elif CRITERION == 1
  share = distance_share(view, distances == vec2(0.0) ? view_numbers.zy : distances);
#elif CRITERION == 2
  share = shares[edge];
#endif
  float needed = tolerance_px > 0.0 ? needed_level(view, edge, view_numbers.x) : float(max_level);
  levels[e] = uint(floor(double(share) * double(needed) * double(kLevelOne) + 0.5lf));  // quantized_level()
}
