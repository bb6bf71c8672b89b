#version 450 core
// Tags the faces with an edge of a level above 0, and all edges of tagged faces (Dyken et al. 2008, section 6.2): the bases of both
// histogram pyramids, and what unrefined triangles are culled by.

#include "compute.glsl"
#include "refine_scene.glsl"
#include "refine_levels.glsl"

layout(std430, binding = 0) readonly buffer Levels { uint levels[]; };
layout(std430, binding = 1) writeonly buffer Faces { uint tagged_faces[]; };
layout(std430, binding = 2) writeonly buffer Edges { uint tagged_edges[]; };  // zeros at first

uniform uint face_count;

void main() {
  uint f = invocation_index();
  if (f >= face_count) return;
  uvec3 e = texelFetch(face_edges, int(f)).xyz;
  bool degenerate = e.x == kInvalid;
  e &= ~kReversed;
  bool tagged = !degenerate && (level_own(levels[e.x]) | level_own(levels[e.y]) | level_own(levels[e.z])) != 0u;
  tagged_faces[f] = tagged ? 1u : 0u;
  if (!tagged) return;
  // From the faces, since any number of them may meet at an edge: all write the same.
  tagged_edges[e.x] = 1u;
  tagged_edges[e.y] = 1u;
  tagged_edges[e.z] = 1u;
}
