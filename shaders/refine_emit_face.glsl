// Hands on a vertex of a refined face: its place, and by the face's corners its normal, texture coordinates and colour.

#include "refine_vertex.glsl"
#include "refine_emit.glsl"

/// The vertex at weights ijk / 2^n. \param point  where it is in the object's space  \param face  counted over instances
void emit_face_vertex(RefinedFace f, uint face, vec3 point, ivec3 ijk, int n) {
  Placement placement = placement_of(f.instance);
  vec3 position = to_world(placement, vec4(point, 1.0));
#ifdef CAPTURED
  captured_position = point;
  captured_source = uvec2(face, uint(ijk.y) | uint(ijk.z) << 12 | uint(n) << 24);
#endif
#ifdef POSITIONS_ONLY
  place_vertex(position);
#else
  vec3 w = vec3(ijk) / float(1 << n);
  emit_surface(position, to_world(placement, vec4(face_normal_at(f, w), 0.0)), face_uv_at(f, w), face_color_at(f, w),
               material_of(f.vertices.x));
#endif
}
