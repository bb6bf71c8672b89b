#version 450 core
// A point of a patch. On a side it depends on the edge's own curve and level alone, in the edge's own order, as everywhere
// (refine_surface.glsl); inside it is the patch's.

#include "refine_scene.glsl"
#include "refine_levels.glsl"
#include "refine_surface.glsl"
#include "refine_tess_corner.glsl"
#include "refine_emit.glsl"

layout(triangles, SPACING, ccw) in;

in Point CORNER points[];

/// The point of side c at weight t of its end, 0 < t < 1.
vec3 side_point(int c, float t, float other) {
  int d = c == 2 ? 0 : c + 1;
  bool backwards = (points[c].side & kBackwards) != 0u;
  EdgeCurve e = EdgeCurve(points[backwards ? d : c].point, backwards ? points[c].far : points[c].near,
                          backwards ? points[c].near : points[c].far, points[backwards ? c : d].point,
                          points[c].side & ~kBackwards);
  float along = backwards ? other : t;
#if FRACTIONAL
  return evaluate_curve(e, along);
#else
  int n = int(level_ceil(e.level));
  return edge_vertex(e, int(along * float(1 << n) + 0.5), n, n);
#endif
}

vec3 patch_point(vec3 w) {
  Patch b = Patch(vec3[3](points[0].point, points[1].point, points[2].point),
                  vec3[6](points[0].near, points[0].far, points[1].near, points[1].far, points[2].near, points[2].far),
                  vec3(0.0));
  b.center = patch_center(b);
  return evaluate_patch(b, w);
}

vec3 point_at(vec3 w) {
  if (w.x > 0.0 && w.y > 0.0 && w.z > 0.0) return patch_point(w);
  if (w.x == 1.0) return points[0].point;
  if (w.y == 1.0) return points[1].point;
  if (w.z == 1.0) return points[2].point;
  if (w.z == 0.0) return side_point(0, w.y, w.x);
  return w.x == 0.0 ? side_point(1, w.z, w.y) : side_point(2, w.x, w.z);
}

void main() {
  vec3 w = gl_TessCoord;
  vec3 point = point_at(w);
  vec3 position = to_world(points[0].instance, vec4(point, 1.0));
#ifdef CAPTURED
  captured_position = point;
  captured_source = uvec2(points[0].face, uint(w.y * 2048.0 + 0.5) | uint(w.z * 2048.0 + 0.5) << 12 | 11u << 24);
#endif
#ifdef POSITIONS_ONLY
  place_vertex(position);
#else
  vec3 p[3] = vec3[3](points[0].point, points[1].point, points[2].point);
  vec3 n[3] = vec3[3](points[0].normal, points[1].normal, points[2].normal);
  emit_surface(position, to_world(points[0].instance, vec4(interpolate_normal(p, n, w), 0.0)),
               points[0].uv * w.x + points[1].uv * w.y + points[2].uv * w.z,
               points[0].color * w.x + points[1].color * w.y + points[2].color * w.z, points[0].material);
#endif
}
