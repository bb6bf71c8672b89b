#version 450 core
// A point of a patch. On a side it depends on the edge's own curve and level alone, in the edge's own order, as everywhere
// (refine_surface.glsl); inside it is the patch's.

#include "refine_levels.glsl"
#include "refine_surface.glsl"
#include "refine_tess_corner.glsl"
#include "refine_emit.glsl"

layout(triangles, SPACING, ccw) in;

in Point CORNER points[];
patch in vec3 center;

/// The point of the side that w lies on, not at its ends.
vec3 side_point(vec3 w) {
  // Chosen, not indexed: what differs between lanes would be gathered.
  bool first = w.z == 0.0;
  bool second = w.x == 0.0;
  vec3 a = first ? points[0].point : second ? points[1].point : points[2].point;
  vec3 b = first ? points[1].point : second ? points[2].point : points[0].point;
  vec3 near = first ? points[0].near : second ? points[1].near : points[2].near;
  vec3 far = first ? points[0].far : second ? points[1].far : points[2].far;
  uint side = first ? points[0].side : second ? points[1].side : points[2].side;
  float to = first ? w.y : second ? w.z : w.x;
  float from = first ? w.x : second ? w.y : w.z;
  bool backwards = (side & kBackwards) != 0u;
  EdgeCurve e = EdgeCurve(backwards ? b : a, backwards ? far : near, backwards ? near : far, backwards ? a : b,
                          side & ~kBackwards);
  float along = backwards ? from : to;
#if FRACTIONAL
  return evaluate_curve(e, along);
#else
  int n = int(level_ceil(e.level));
  return edge_vertex(e, curve_bend(e), int(along * float(1 << n) + 0.5), n, n);
#endif
}

vec3 patch_point(vec3 w) {
  Patch b = Patch(vec3[3](points[0].point, points[1].point, points[2].point),
                  vec3[6](points[0].near, points[0].far, points[1].near, points[1].far, points[2].near, points[2].far),
                  center);
  return evaluate_patch(b, w);
}

vec3 point_at(vec3 w) {
  if (w.x > 0.0 && w.y > 0.0 && w.z > 0.0) return patch_point(w);
  if (w.x == 1.0) return points[0].point;
  if (w.y == 1.0) return points[1].point;
  if (w.z == 1.0) return points[2].point;
  return side_point(w);
}

void main() {
  vec3 w = gl_TessCoord;
  vec3 position = point_at(w);
#ifdef CAPTURED
  captured_position = position;  // in world space
  captured_source = uvec2(points[0].face, uint(w.y * 2048.0 + 0.5) | uint(w.z * 2048.0 + 0.5) << 12 | 11u << 24);
#endif
#ifdef POSITIONS_ONLY
  place_vertex(position);
#else
  vec3 p[3] = vec3[3](points[0].point, points[1].point, points[2].point);
  vec3 n[3] = vec3[3](points[0].normal, points[1].normal, points[2].normal);
  emit_surface(position, interpolate_normal(p, n, w),
               points[0].uv * w.x + points[1].uv * w.y + points[2].uv * w.z,
               points[0].color * w.x + points[1].color * w.y + points[2].color * w.z, points[0].material);
#endif
}
