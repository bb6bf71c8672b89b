#include "coarse.h"

#include "limn/mesh/normals.h"
#include "limn/mesh/topology.h"

#include "reduce.h"

namespace limn::bench {

Result<Mesh> coarse_mesh(const Mesh& mesh, std::size_t faces) {
  constexpr float kAllSmooth = 4.0f;
  Mesh low = reduce(mesh, faces, kAllSmooth);
  low.normals = crease_normals(low, build_topology(low), kAllSmooth);
  const float away = static_cast<float>(0.01 * face_bounds(mesh).diagonal());
  std::vector<bool> moved(low.positions.size(), false);
  for (FaceId face = 0; face < low.faces.size(); ++face) {
    for (int c = 0; c < 3; ++c) {
      const VertexId vertex = low.faces[face][static_cast<std::size_t>(c)];
      if (moved[vertex]) continue;
      moved[vertex] = true;
      low.positions[vertex] += away * low.corner(low.normals, face, c);
    }
  }
  return low;
}

}  // namespace limn::bench
