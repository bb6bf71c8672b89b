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

Material plain_material(const Mesh& mesh) {
  Material material;
  material.base_color = mesh.colors.empty() ? Vec4(0.60f, 0.55f, 0.47f, 1.0f) : Vec4(1.0f);
  material.roughness = 0.38f;
  return material;
}

}  // namespace limn
