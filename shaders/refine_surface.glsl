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

// Written without branches where it can be: what a vertex does not need is multiplied by 0, since devices that run vertices side
// by side would do the work anyway.

/// The share of its detail that a vertex of this level has.
float surplus_share(uint level, int vertex_level) {
  return clamp(float(level) * kLevelUnit - float(vertex_level - 1), 0.0, 1.0);
}

/// A sixth of the curve's second derivative at its ends, linear in between. A cubic's fourth derivative is 0, so that a point's
/// distance from the middle of those h before and after it is exactly -3h² times this.
struct CurveBend {
  vec3 d0, d1;
};

CurveBend curve_bend(EdgeCurve e) {
  precise vec3 d0 = (e.p0 - 2.0 * e.c0) + e.c1;
  precise vec3 d1 = (e.c0 - 2.0 * e.c1) + e.p1;
  return CurveBend(d0, d1);
}

/// The edge's surface at k / 2^n, a vertex that its level asks for or an end.
vec3 edge_vertex(EdgeCurve e, CurveBend bend, int k, int n, int finest) {
  float t = float(k) / float(1 << n);
  float h = 1.0 / float(1 << finest);
  float missing = n - findLSB(k) == finest ? 1.0 - surplus_share(e.level, finest) : 0.0;
  precise vec3 p = evaluate_curve(e, t) - (bend.d0 * (1.0 - t) + bend.d1 * t) * (-3.0 * h * h * missing);
  return p;
}

/// The edge's surface at k / 2^n from its first end, 0 < k < 2^n: what sample_edge() puts there. Finer points than the level
/// asks for, which nested patterns have, lie on the segments between its vertices.
vec3 edge_point(EdgeCurve e, int k, int n) {
  CurveBend bend = curve_bend(e);
  int finest = int(level_ceil(e.level));
#if NESTED
  int step = n > finest ? 1 << (n - finest) : 1;
  int low = k & ~(step - 1);
  int high = low + step;
  vec3 a = low == 0 ? e.p0 : edge_vertex(e, bend, low, n, finest);
  vec3 b = high == 1 << n ? e.p1 : edge_vertex(e, bend, high, n, finest);
  float x = float(k - low) / float(step);
  precise vec3 p = a * (1.0 - x) + b * x;
  return p;
#else
  return edge_vertex(e, bend, k, n, finest);
#endif
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

/// A sixth of the patch's second derivative along each side at each corner, linear in between: b[3 * side + corner].
struct PatchBend {
  vec3 b[9];
};

PatchBend patch_bend(Patch b) {
  return PatchBend(vec3[9](b.p[0] - 2.0 * b.c[0] + b.c[1], b.c[0] - 2.0 * b.c[1] + b.p[1], b.c[5] - 2.0 * b.center + b.c[2],
                           b.c[1] - 2.0 * b.center + b.c[4], b.p[1] - 2.0 * b.c[2] + b.c[3], b.c[2] - 2.0 * b.c[3] + b.p[2],
                           b.c[4] - 2.0 * b.c[5] + b.p[0], b.c[3] - 2.0 * b.center + b.c[0], b.p[2] - 2.0 * b.c[4] + b.c[5]));
}

/// What the vertices of one level on a side, where each is missing `share` of its detail, take from a point inside: the sum of
/// their hat functions times detail, as factors of the curve's two bends. Only the row of triangles along the side has any.
/// \param x, z  the point, along the side and across it, in units of which `unit` are a segment of the level
vec2 side_factors(int x, int z, int unit, float h, float share) {
  int cell = x / unit;
  float fx = float(x - cell * unit) / float(unit);
  float fz = float(z) / float(unit);
  bool odd = (cell & 1) != 0;
  bool upward = fx + fz <= 1.0;
  float hat = odd ? (upward ? 1.0 - fx - fz : 0.0) : (upward ? fx : 1.0 - fz);
  float t = float(cell | 1) * h;  // the vertex of the two ends of the cell that the level brings
  float factor = z < unit ? 3.0 * h * h * hat * share : 0.0;
  return vec2(factor * (1.0 - t), factor * t);
}

/// The surface inside a face at weights ijk / 2^n: the patch sampled at the largest level, less what its sides, where they are
/// coarser, keep from it. sample_interior() finds the same vertex by vertex, from parents.
vec3 interior_point(Patch b, PatchBend bend, uvec3 side_levels, ivec3 ijk, int n) {
  uint largest = max(max(side_levels.x, side_levels.y), side_levels.z);
  int finest = int(level_ceil(largest));
  vec3 w = vec3(ijk) / float(1 << n);
  vec3 p = evaluate_patch(b, w);
  // The vertices of the level that is fading in lie off the patch, towards the middle of the segment that each halves: along
  // the side that its two odd weights span.
  int vertex_level = n - findLSB(ijk.x | ijk.y | ijk.z);
  float h = 1.0 / float(1 << finest);
  float missing = vertex_level == finest ? 3.0 * h * h * (1.0 - surplus_share(largest, finest)) : 0.0;
  ivec3 odd = ijk >> (n - finest) & 1;
  vec3 factors = missing * vec3(odd.x & odd.y, odd.y & odd.z, odd.z & odd.x);
  p += (bend.b[0] * w.x + bend.b[1] * w.y + bend.b[2] * w.z) * factors.x +
       (bend.b[3] * w.x + bend.b[4] * w.y + bend.b[5] * w.z) * factors.y +
       (bend.b[6] * w.x + bend.b[7] * w.y + bend.b[8] * w.z) * factors.z;
  vec2 x = vec2(0.0), y = vec2(0.0), z = vec2(0.0);
  bool even_sides = side_levels.x == side_levels.y && side_levels.y == side_levels.z;
  for (int level = even_sides || paper_blend ? finest + 1 : 1; level <= finest; ++level) {
    float inside = surplus_share(largest, level);
    int unit = 1 << (n - level);
    float size = 1.0 / float(1 << level);
    x += side_factors(ijk.y, ijk.z, unit, size, inside - surplus_share(side_levels.x, level));
    y += side_factors(ijk.z, ijk.x, unit, size, inside - surplus_share(side_levels.y, level));
    z += side_factors(ijk.x, ijk.y, unit, size, inside - surplus_share(side_levels.z, level));
  }
  return p + (bend.b[0] * x.x + bend.b[1] * x.y) + (bend.b[4] * y.x + bend.b[5] * y.y) + (bend.b[8] * z.x + bend.b[6] * z.y);
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

/// Control normals of the quadratic field: at the corners, then in the middles of the sides.
struct NormalField {
  vec3 n[6];
};

NormalField normal_field(vec3 p[3], vec3 n[3]) {
  return NormalField(vec3[6](n[0], n[1], n[2], middle_normal(p[0], p[1], n[0], n[1]), middle_normal(p[1], p[2], n[1], n[2]),
                             middle_normal(p[2], p[0], n[2], n[0])));
}

/// The normal at weights w, of unit length.
vec3 interpolate_normal(NormalField field, vec3 w) {
  vec3 sum = field.n[0] * (w.x * w.x) + field.n[1] * (w.y * w.y) + field.n[2] * (w.z * w.z) + field.n[3] * (w.x * w.y) +
             field.n[4] * (w.y * w.z) + field.n[5] * (w.z * w.x);
  float size = length(sum);
  return size > 1e-6 ? sum / size : field.n[0];
}

vec3 interpolate_normal(vec3 p[3], vec3 n[3], vec3 w) { return interpolate_normal(normal_field(p, n), w); }
