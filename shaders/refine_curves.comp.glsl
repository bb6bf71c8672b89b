#version 450 core
// The inner control points of every edge of the objects: the twin of edge_curves() (refine/edge_curve.h), which says what the
// rules are for.

#include "compute.glsl"
#include "refine_scene.glsl"
#include "refine_edge_tables.glsl"
#include "exact_float.glsl"

layout(std430, binding = 0) writeonly buffer Curves { float points[]; };

uniform uint edge_count;

const double kSameNormalSine = 0.0175lf;
const double kSharpCosine = 0.5lf;

dvec3 exact_point(uvec3 bits) {
  return dvec3(exact_value(bits.x), exact_value(bits.y), exact_value(bits.z));
}

double dot_of(dvec3 a, dvec3 b) {
  precise double sum = a.x * b.x + a.y * b.y + a.z * b.z;
  return sum;
}

dvec3 straight_end(dvec3 p, dvec3 q) {
  precise dvec3 c = (2.0lf * p + q) / 3.0lf;
  return c;
}

dvec3 smooth_end(dvec3 p, dvec3 q, dvec3 n) {
  precise dvec3 c = (2.0lf * p + q) / 3.0lf - n * (dot_of(q - p, n) / 3.0lf);
  return c;
}

dvec3 curve_end(dvec3 p, dvec3 q, dvec3 ns, dvec3 nt) {
  precise dvec3 turn = dvec3(ns.y * nt.z - nt.y * ns.z, ns.z * nt.x - nt.z * ns.x, ns.x * nt.y - nt.x * ns.y);
  double sine = sqrt(dot_of(turn, turn));
  if (sine < kSameNormalSine) {
    dvec3 mean = dot_of(ns, nt) >= 0.0lf ? ns + nt : ns - nt;
    return smooth_end(p, q, mean / sqrt(dot_of(mean, mean)));
  }
  dvec3 t = turn / sine;
  double along = dot_of(q - p, t);
  if (abs(along) < kSharpCosine * sqrt(dot_of(q - p, q - p))) return straight_end(p, q);
  precise dvec3 c = p + t * (along / 3.0lf);
  return c;
}

dvec3 normal_at(uint v) {
  return exact_point(texelFetch(normals, int(v)).xyz);
}

void put(uint at, dvec3 c) {
  points[at] = float(c.x);
  points[at + 1u] = float(c.y);
  points[at + 2u] = float(c.z);
}

void main() {
  uint e = invocation_index();
  if (e >= edge_count) return;
  uvec2 sides = texelFetch(edge_faces, int(e)).xy;
  uvec2 s = edge_ends(e, sides.x);
  uvec2 t = sides.y >= kManyFaces ? s : edge_ends(e, sides.y);
  dvec3 p = exact_point(texelFetch(positions, int(s.x)).xyz);
  dvec3 q = exact_point(texelFetch(positions, int(s.y)).xyz);
  bool straight = sides.y == kManyFaces;
  put(6u * e, straight ? straight_end(p, q) : curve_end(p, q, normal_at(s.x), normal_at(t.x)));
  put(6u * e + 3u, straight ? straight_end(q, p) : curve_end(q, p, normal_at(s.y), normal_at(t.y)));
}
