// What the passes that select patterns share (render/refinement/pattern_selection.h): how faces find their edges' words,
// and what they write.

#include "compute.glsl"
#include "refine_scene.glsl"
#include "refine_levels.glsl"

// A face's key: 0 unrefined, kCulled degenerate or no face; else base | mirrored << 12 | corners << 13.
const uint kCulled = 0xffffffffu;
uint key_base(uint key) { return key & 0xfffu; }
/// Two groups a base but the first: as stored, mirrored.
uint key_group(uint key) { return 2u * key_base(key) + (key >> 12 & 1u) - 2u; }
/// What the vertex stage is given of a refined face: the face and its corners.
uint list_entry(uint face, uint key) { return face | (key >> 13) << 28; }

const uint kSortBlock = 1024u;  // refined faces that a workgroup sorts

layout(std430, binding = 0) buffer Levels { uint levels[]; };
// 0: cut; 1: unrefined faces; 2: refined ones; 3: budget; from 4: as noted in the passes
layout(std430, binding = 1) buffer Frame { uint frame[]; };
layout(std430, binding = 2) buffer Keys { uint keys[]; };       // a face; later the sorted entries
layout(std430, binding = 3) buffer Lists { uint lists[]; };     // from the front unrefined triangles' vertices, from the back refined faces and keys
layout(std430, binding = 4) buffer Blocks { uvec2 blocks[]; };  // each 256 faces: unrefined, refined
layout(std430, binding = 5) buffer Groups { uint group_counts[]; };  // each kSortBlock refined faces: a count a group

uniform uint face_capacity;
uniform uint group_count;

/// The instance of this workgroup's faces, and its ranges.
struct FaceRange {
  uint instance;
  uvec4 faces, edges;
};
FaceRange face_range() {
  uint instance = texelFetch(face_blocks, int(workgroup_index())).x;
  return FaceRange(instance, instance_faces(instance), instance_edges(instance));
}
bool is_face(FaceRange range, uint f) { return f - range.faces.x < range.faces.z; }
uint object_face(FaceRange range, uint f) { return range.faces.y + (f - range.faces.x); }

/// Where the words of a face's edges are. \pre the face is not degenerate
uvec3 edge_words_at(FaceRange range, uvec3 edges) {
  return (edges & ~kReversed) - range.edges.y + range.edges.x;
}

uvec3 edge_words(FaceRange range, uvec3 edges) {
  uvec3 at = edge_words_at(range, edges);
  return uvec3(levels[at.x], levels[at.y], levels[at.z]);
}

/// Slots of `lists` count from its end for refined faces.
uint refined_slot(uint n) { return 3u * face_capacity - 2u * n - 2u; }
