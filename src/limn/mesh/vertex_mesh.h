#pragma once

#include <vector>

#include "limn/mesh/mesh.h"

namespace limn {

/// One value a vertex: the mesh with a vertex repeated where its corners' attributes differ, as PLY, glTF and
/// graphics devices need it.
/// Attributes come back without indices. Vertices keep their order, repeats follow. Same bits for any number of
/// threads.
struct VertexMesh {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;
  std::vector<Vec2> uvs;
  std::vector<Vec4> colors;
  std::vector<Vec4> tangents;
  std::vector<Triangle> faces;
  std::vector<VertexId> source;  ///< one a vertex: the mesh's position it repeats
};
VertexMesh one_value_per_vertex(const Mesh& mesh);

}  // namespace limn
