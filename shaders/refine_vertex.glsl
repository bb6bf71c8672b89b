// A vertex of a refined face from the scene's tables: what both the vertex stage and the pass that stores vertices evaluate.

#include "refine_scene.glsl"
#include "refine_levels.glsl"
#include "refine_surface.glsl"

layout(binding = 11) uniform usamplerBuffer edge_levels;  // refine_levels.glsl
layout(binding = 12) uniform usamplerBuffer frame;        // the cut a budget takes

/// A face of an instance, by the tables.
struct RefinedFace {
  uint instance;
  uvec3 vertices, edges;
  uvec3 levels;
};

uint level_of(uint instance_edge) {
  return level_cut(level_own(texelFetch(edge_levels, int(instance_edge)).x), texelFetch(frame, 0).x);
}

/// All but the levels, which are 0.
RefinedFace face_tables_of(uint face) {
  RefinedFace f;
  f.instance = texelFetch(face_blocks, int(face >> 8)).x;
  uvec4 faces = instance_faces(f.instance);
  int row = int(face - faces.x + faces.y);
  f.vertices = texelFetch(face_vertices, row).xyz;
  f.edges = texelFetch(face_edges, row).xyz;
  f.levels = uvec3(0u);
  return f;
}

RefinedFace refined_face(uint face) {
  RefinedFace f = face_tables_of(face);
  uvec4 edges = instance_edges(f.instance);
  uvec3 at = (f.edges & ~kReversed) - edges.y + edges.x;
  f.levels = uvec3(level_of(at.x), level_of(at.y), level_of(at.z));
  return f;
}

/// The same face with its corners in another order: corner b of the result is corner order[b] of f. Weights and sides are the
/// result's from then on.
RefinedFace reordered(RefinedFace f, ivec3 order) {
  RefinedFace r;
  r.instance = f.instance;
  r.vertices = uvec3(f.vertices[order.x], f.vertices[order.y], f.vertices[order.z]);
  bool mirrored = order.y != (order.x == 2 ? 0 : order.x + 1);
  ivec3 side = mirrored ? order.yzx : order;  // of f: that which joins the result's corners b and b + 1
  r.edges = uvec3(f.edges[side.x], f.edges[side.y], f.edges[side.z]) ^ (mirrored ? kReversed : 0u);
  r.levels = uvec3(f.levels[side.x], f.levels[side.y], f.levels[side.z]);
  return r;
}

Patch patch_of(RefinedFace f) {
  Patch b;
  for (int c = 0; c < 3; ++c) {
    b.p[c] = position_of(f.vertices[c]);
    uint edge = f.edges[c] & ~kReversed;
    uint first = f.edges[c] >> 31;
    b.c[2 * c] = control_point(edge, first);
    b.c[2 * c + 1] = control_point(edge, 1u - first);
  }
  b.center = patch_center(b);
  return b;
}

/// The curve of side 0, 1 or 2 in the edge's own order. Chosen from the patch's points, which all sides have loaded anyway.
EdgeCurve side_curve(Patch b, uvec3 edges, uvec3 levels, int side) {
  vec3 p0 = side == 0 ? b.p[0] : side == 1 ? b.p[1] : b.p[2];
  vec3 p1 = side == 0 ? b.p[1] : side == 1 ? b.p[2] : b.p[0];
  vec3 c0 = side == 0 ? b.c[0] : side == 1 ? b.c[2] : b.c[4];
  vec3 c1 = side == 0 ? b.c[1] : side == 1 ? b.c[3] : b.c[5];
  uint level = side == 0 ? levels.x : side == 1 ? levels.y : levels.z;
  uint edge = side == 0 ? edges.x : side == 1 ? edges.y : edges.z;
  bool reversed = (edge & kReversed) != 0u;
  return EdgeCurve(reversed ? p1 : p0, reversed ? c1 : c0, reversed ? c0 : c1, reversed ? p0 : p1, level);
}

/// A point of weights ijk / 2^n on a side: k / 2^n from the first end of the side's edge.
struct SidePlace {
  int side, k;
};
SidePlace side_place(RefinedFace f, ivec3 ijk, int n) {
  int side = ijk.z == 0 ? 0 : ijk.x == 0 ? 1 : 2;
  int along = side == 0 ? ijk.y : side == 1 ? ijk.z : ijk.x;
  bool reversed = ((side == 0 ? f.edges.x : side == 1 ? f.edges.y : f.edges.z) & kReversed) != 0u;
  return SidePlace(side, reversed ? (1 << n) - along : along);
}

/// The point of the face at weights ijk / 2^n, in the object's space.
vec3 face_point(RefinedFace f, ivec3 ijk, int n) {
  int whole = 1 << n;
  Patch b = patch_of(f);
  SidePlace at = side_place(f, ijk, n);
  vec3 point = edge_point(side_curve(b, f.edges, f.levels, at.side), at.k, n);
  if (ijk.x != 0 && ijk.y != 0 && ijk.z != 0) point = interior_point(b, patch_bend(b), f.levels, ijk, n);
  if (ijk.x == whole) point = b.p[0];
  if (ijk.y == whole) point = b.p[1];
  if (ijk.z == whole) point = b.p[2];
  return point;
}

/// The point of the patch itself at weights ijk / 2^n, and of the edge's curve on an edge: what a face of whole levels has there
/// that is not blended. Exact at corners. The face's levels do not matter.
vec3 unblended_point(RefinedFace f, ivec3 ijk, int n) {
  Patch b = patch_of(f);
  SidePlace at = side_place(f, ijk, n);
  vec3 point = evaluate_curve(side_curve(b, f.edges, f.levels, at.side), float(at.k) / float(1 << n));
  if (ijk.x != 0 && ijk.y != 0 && ijk.z != 0) point = evaluate_patch(b, vec3(ijk) / float(1 << n));
  return point;
}

NormalField normal_field_of(RefinedFace f) {
  return normal_field(vec3[3](position_of(f.vertices.x), position_of(f.vertices.y), position_of(f.vertices.z)),
                      vec3[3](normal_of(f.vertices.x), normal_of(f.vertices.y), normal_of(f.vertices.z)));
}

mat3x2 corner_uvs(RefinedFace f) {
  return mat3x2(uv_of(f.vertices.x), uv_of(f.vertices.y), uv_of(f.vertices.z));
}
vec2 interpolate(mat3x2 values, vec3 w) { return values[0] * w.x + values[1] * w.y + values[2] * w.z; }

mat3x4 corner_colors(RefinedFace f) {
  return mat3x4(color_of(f.vertices.x), color_of(f.vertices.y), color_of(f.vertices.z));
}
vec4 interpolate(mat3x4 values, vec3 w) { return values[0] * w.x + values[1] * w.y + values[2] * w.z; }

vec3 face_normal_at(RefinedFace f, vec3 w) { return interpolate_normal(normal_field_of(f), w); }
vec2 face_uv_at(RefinedFace f, vec3 w) { return interpolate(corner_uvs(f), w); }
vec4 face_color_at(RefinedFace f, vec3 w) { return interpolate(corner_colors(f), w); }
