#version 450 core
// Lists unrefined triangles and refined faces, each in ascending order.

#include "refine_selection.glsl"
#include "scan.glsl"

void main() {
  uint f = invocation_index();
  uint key = f < face_capacity ? keys[f] : kCulled;
  uint unused;
  uint both = exclusive_scan(key == kCulled ? 0u : key == 0u ? 1u : 1u << 16, unused);
  if (key == kCulled) return;
  uvec2 first = blocks[workgroup_index()];
  if (key != 0u) {
    uint slot = refined_slot(first.y + (both >> 16));
    lists[slot] = f;
    lists[slot + 1u] = key;
    return;
  }
  FaceRange range = face_range();
  uvec3 v = texelFetch(face_vertices, int(object_face(range, f))).xyz - range.edges.w + range.faces.w;
  uint at = 3u * (first.x + (both & 0xffffu));
  lists[at] = v.x;
  lists[at + 1u] = v.y;
  lists[at + 2u] = v.z;
}
