#include "limn/mesh/mesh.h"

namespace limn {

Bounds face_bounds(const Mesh& mesh) {
  Bounds bounds;
  for (const Triangle& face : mesh.faces) {
    for (const VertexId v : face)
      bounds.add(mesh.positions[v]);
  }
  return bounds;
}

}  // namespace limn
