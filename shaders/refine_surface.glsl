// Points of the refined surface, from integers: the twin of sample_edge(), sample_interior() (refine/blend.h), evaluate_curve()
// and evaluate_patch(). A point on an edge depends on that edge's curve and level alone, so that all faces there find the same
// bits (docs/watertight.md): hence `precise`, and ends in the edge's own order.

uniform bool paper_blend;    // equations (9)-(11) of Dyken et al. 2008 as published, else hierarchical surplus
uniform bool mean_center;    // equation (5), else (4)

/// An edge with its end points in its own order, and its geometric level.
struct EdgeCurve {
  vec3 p0, c0, c1, p1;
  uint level;  // refine_levels.glsl
};

vec3 evaluate_curve(EdgeCurve e, float t) {
  precise float r = 1.0 - t;
  precise float b0 = r * r * r;
  precise float b1 = 3.0 * r * r * t;
  precise float b2 = 3.0 * r * t * t;
  precise float b3 = t * t * t;
  precise vec3 p = (b0 * e.p0 + b1 * e.c0) + (b2 * e.c1 + b3 * e.p1);
  return p;
}

/// How far the curve at t is from the middle between its points at t - h and t + h: a cubic's fourth derivative is 0, so that
/// this is exactly -h²/2 of its second.
vec3 curve_detail(EdgeCurve e, float t, float h) {
  precise vec3 d0 = (e.p0 - 2.0 * e.c0) + e.c1;
  precise vec3 d1 = (e.c0 - 2.0 * e.c1) + e.p1;
  precise vec3 detail = (d0 * (1.0 - t) + d1 * t) * (-3.0 * h * h);
  return detail;
}

/// The share of its detail that a vertex of this level has.
float surplus_share(uint level, int vertex_level) {
  return clamp(float(level) * kLevelUnit - float(vertex_level - 1), 0.0, 1.0);
}

/// The edge's surface at k / 2^finest, a vertex no finer than its level asks for.
vec3 edge_vertex(EdgeCurve e, int k, int n, int finest) {
  float t = float(k) / float(1 << n);
  vec3 f = evaluate_curve(e, t);
  if (n - findLSB(k) < finest || (e.level & (kLevelOne - 1u)) == 0u) return f;
  float h = 1.0 / float(1 << finest);
  precise vec3 p = f - curve_detail(e, t, h) * (1.0 - surplus_share(e.level, finest));
  return p;
}

/// The edge's surface at k / 2^n from its first end, 0 < k < 2^n: what sample_edge() puts there. Finer points than the level
/// asks for lie on the segments between its vertices.
vec3 edge_point(EdgeCurve e, int k, int n) {
  int finest = int(level_ceil(e.level));
  int step = n > finest ? 1 << (n - finest) : 1;
  int low = k & ~(step - 1);
  int high = low + step;
  vec3 a = low == 0 ? e.p0 : edge_vertex(e, low, n, finest);
  if (low == k) return a;
  vec3 b = high == 1 << n ? e.p1 : edge_vertex(e, high, n, finest);
  float x = float(k - low) / float(step);
  precise vec3 p = a * (1.0 - x) + b * x;
  return p;
}

/// A face's cubic patch; c[2i] and c[2i + 1] beside the first and the second end of side i.
struct Patch {
  vec3 p[3];
  vec3 c[6];
  vec3 center;
};

vec3 patch_center(Patch patch_) {
  vec3 sum = ((patch_.c[0] + patch_.c[1]) + (patch_.c[2] + patch_.c[3])) + (patch_.c[4] + patch_.c[5]);
  if (mean_center) return sum / 6.0;
  return sum * 0.25 - (patch_.p[0] + patch_.p[1] + patch_.p[2]) / 6.0;
}

vec3 evaluate_patch(Patch b, vec3 w) {
  vec3 w2 = w * w;
  vec3 corners = b.p[0] * (w2.x * w.x) + b.p[1] * (w2.y * w.y) + b.p[2] * (w2.z * w.z);
  vec3 sides = b.c[0] * (w2.x * w.y) + b.c[1] * (w.x * w2.y) + b.c[2] * (w2.y * w.z) + b.c[3] * (w.y * w2.z) +
               b.c[4] * (w2.z * w.x) + b.c[5] * (w.z * w2.x);
  return corners + sides * 3.0 + b.center * (6.0 * (w.x * w.y * w.z));
}

/// A sixth of the patch's second derivative along side `along`, at weights w.
vec3 patch_bend(Patch b, int along, vec3 w) {
  if (along == 0)
    return (b.p[0] - 2.0 * b.c[0] + b.c[1]) * w.x + (b.c[0] - 2.0 * b.c[1] + b.p[1]) * w.y +
           (b.c[5] - 2.0 * b.center + b.c[2]) * w.z;
  if (along == 1)
    return (b.p[1] - 2.0 * b.c[2] + b.c[3]) * w.y + (b.c[2] - 2.0 * b.c[3] + b.p[2]) * w.z +
           (b.c[1] - 2.0 * b.center + b.c[4]) * w.x;
  return (b.p[2] - 2.0 * b.c[4] + b.c[5]) * w.z + (b.c[4] - 2.0 * b.c[5] + b.p[0]) * w.x +
         (b.c[3] - 2.0 * b.center + b.c[0]) * w.y;
}

/// What a side's vertices of one level give to a point inside, when each is missing `share` of its detail: the sum of their hat
/// functions times detail times share. Only the row of triangles along the side holds any.
/// \param x, z  the point, in segments of 2^-level, along the side and across it
vec3 side_detail(vec3 p0, vec3 c0, vec3 c1, vec3 p1, int x, int z, int unit, int level, float share) {
  if (z >= unit) return vec3(0.0);
  int cell = x / unit;
  float fx = float(x - cell * unit) / float(unit);
  float fz = float(z) / float(unit);
  bool upward = fx + fz <= 1.0;
  bool odd = (cell & 1) != 0;
  float hat = odd ? (upward ? 1.0 - fx - fz : 0.0) : (upward ? fx : 1.0 - fz);
  float h = 1.0 / float(1 << level);
  float t = float(odd ? cell : cell + 1) * h;
  vec3 bend = (p0 - 2.0 * c0 + c1) * (1.0 - t) + (c0 - 2.0 * c1 + p1) * t;
  return bend * (-3.0 * h * h * hat * share);
}

/// The surface inside a face at weights ijk / 2^n: the patch sampled at the largest level, less what its sides, where they are
/// coarser, keep from it. sample_interior() finds the same vertex by vertex, from parents.
vec3 interior_point(Patch b, uvec3 side_levels, ivec3 ijk, int n) {
  uint largest = max(max(side_levels.x, side_levels.y), side_levels.z);
  int finest = int(level_ceil(largest));
  vec3 w = vec3(ijk) / float(1 << n);
  vec3 p = evaluate_patch(b, w);
  // The vertices of the level that is fading in.
  int vertex_level = n - findLSB(ijk.x | ijk.y | ijk.z);
  float share = surplus_share(largest, finest);
  if (vertex_level == finest && share < 1.0) {
    int bit = n - finest;
    // The two odd weights span the side that the halved segment runs along.
    bool odd_x = (ijk.x >> bit & 1) != 0;
    bool odd_y = (ijk.y >> bit & 1) != 0;
    int along = odd_x && odd_y ? 0 : odd_y ? 1 : 2;
    float h = 1.0 / float(1 << finest);
    p += patch_bend(b, along, w) * (3.0 * h * h * (1.0 - share));
  }
  if (paper_blend || (side_levels.x == side_levels.y && side_levels.y == side_levels.z)) return p;
  for (int level = 1; level <= finest; ++level) {
    float inside = surplus_share(largest, level);
    vec3 missing = vec3(inside - surplus_share(side_levels.x, level), inside - surplus_share(side_levels.y, level),
                        inside - surplus_share(side_levels.z, level));
    int unit = 1 << (n - level);
    if (missing.x > 0.0) p -= side_detail(b.p[0], b.c[0], b.c[1], b.p[1], ijk.y, ijk.z, unit, level, missing.x);
    if (missing.y > 0.0) p -= side_detail(b.p[1], b.c[2], b.c[3], b.p[2], ijk.z, ijk.x, unit, level, missing.y);
    if (missing.z > 0.0) p -= side_detail(b.p[2], b.c[4], b.c[5], b.p[0], ijk.x, ijk.y, unit, level, missing.z);
  }
  return p;
}

/// The edge normal of Vlachos et al. 2001: the ends' mean, reflected across the plane that halves the edge.
vec3 middle_normal(vec3 p, vec3 q, vec3 np, vec3 nq) {
  vec3 along = q - p;
  vec3 sum = np + nq;
  float squared = dot(along, along);
  vec3 reflected = squared > 0.0 ? sum - (2.0 * dot(along, sum) / squared) * along : sum;
  float size = length(reflected);
  return size > 1e-12 ? reflected / size : np;
}

/// The quadratic normal at weights w, of unit length.
vec3 interpolate_normal(vec3 p[3], vec3 n[3], vec3 w) {
  vec3 sum = n[0] * (w.x * w.x) + n[1] * (w.y * w.y) + n[2] * (w.z * w.z) +
             middle_normal(p[0], p[1], n[0], n[1]) * (w.x * w.y) + middle_normal(p[1], p[2], n[1], n[2]) * (w.y * w.z) +
             middle_normal(p[2], p[0], n[2], n[0]) * (w.z * w.x);
  float size = length(sum);
  return size > 1e-6 ? sum / size : n[0];
}
