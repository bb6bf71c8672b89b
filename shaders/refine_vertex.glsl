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

RefinedFace refined_face(uint face) {
  RefinedFace f;
  f.instance = texelFetch(face_blocks, int(face >> 8)).x;
  uvec4 faces = instance_faces(f.instance);
  uvec4 edges = instance_edges(f.instance);
  int row = int(face - faces.x + faces.y);
  f.vertices = texelFetch(face_vertices, row).xyz;
  f.edges = texelFetch(face_edges, row).xyz;
  uvec3 at = (f.edges & ~kReversed) - edges.y + edges.x;
  f.levels = uvec3(level_of(at.x), level_of(at.y), level_of(at.z));
  return f;
}

/// The curve of side c of the face in the edge's own order.
EdgeCurve side_curve(RefinedFace f, int c) {
  uint edge = f.edges[c] & ~kReversed;
  bool reversed = (f.edges[c] & kReversed) != 0u;
  vec3 a = position_of(f.vertices[c]);
  vec3 b = position_of(f.vertices[c == 2 ? 0 : c + 1]);
  return EdgeCurve(reversed ? b : a, control_point(edge, 0u), control_point(edge, 1u), reversed ? a : b, f.levels[c]);
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

/// The point of the face at weights ijk / 2^n, in the object's space.
vec3 face_point(RefinedFace f, ivec3 ijk, int n) {
  int whole = 1 << n;
  if (ijk.x == whole) return position_of(f.vertices.x);
  if (ijk.y == whole) return position_of(f.vertices.y);
  if (ijk.z == whole) return position_of(f.vertices.z);
  if (ijk.x != 0 && ijk.y != 0 && ijk.z != 0) {
    Patch b = patch_of(f);
    return interior_point(b, patch_bend(b), f.levels, ijk, n);
  }
  int c = ijk.z == 0 ? 0 : ijk.x == 0 ? 1 : 2;
  int along = c == 0 ? ijk.y : c == 1 ? ijk.z : ijk.x;
  bool reversed = (f.edges[c] & kReversed) != 0u;
  return edge_point(side_curve(f, c), reversed ? whole - along : along, n);
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
