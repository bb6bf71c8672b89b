#version 450 core
// Fetches a corner of a face and puts it in world space, once for all points of its patch. The index names face and corner:
// gl_PrimitiveID cannot be relied on in the stages that tessellate.

#include "refine_scene.glsl"
#include "refine_levels.glsl"
#include "refine_tess_corner.glsl"

layout(binding = 11) uniform usamplerBuffer edge_levels;

out Corner CORNER corner;

void main() {
  uint face = uint(gl_VertexID) / 3u;
  uint c = uint(gl_VertexID) - 3u * face;
  uint instance = texelFetch(face_blocks, int(face >> 8)).x;
  uvec4 faces = instance_faces(instance);
  uvec4 edges = instance_edges(instance);
  int row = int(face - faces.x + faces.y);
  uint v = texelFetch(face_vertices, row)[c];
  uint side = texelFetch(face_edges, row)[c];
  corner.point = to_world(instance, vec4(position_of(v), 1.0));
  corner.face = face;
#ifndef POSITIONS_ONLY
  corner.normal = to_world(instance, vec4(normal_of(v), 0.0));
  corner.uv = uv_of(v);
  corner.color = color_of(v);
  corner.material = material_of(v);
#endif
  if (side == kInvalid) {
    corner.near = corner.far = corner.point;
    corner.side = kNoPatch;
    return;
  }
  uint edge = side & ~kReversed;
  uint first = side >> 31;
  corner.near = to_world(instance, vec4(control_point(edge, first), 1.0));
  corner.far = to_world(instance, vec4(control_point(edge, 1u - first), 1.0));
  corner.side = level_own(texelFetch(edge_levels, int(edge - edges.y + edges.x)).x) | (side & kReversed);
}
