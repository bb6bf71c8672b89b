#include "limn/render/clip/hull_shell.h"

#include "limn/mesh/topology.h"

namespace limn {
namespace {

/// Which edge of `face` is `edge`.
std::uint32_t place_of(const Topology& topology, FaceId face, EdgeId edge) {
  std::uint32_t c = 0;
  while (topology.face_edges[face][c] != edge)
    ++c;
  return c;
}

std::uint32_t beyond(const Topology& topology, FaceId face, std::size_t c) {
  const EdgeId edge = topology.face_edges[face][c];
  if (edge == kInvalidId || topology.edge_class[edge] != EdgeClass::kManifold) return kInvalidId;
  const Edge& e = topology.edges[edge];
  const FaceId other = e.face[0] == face ? e.face[1] : e.face[0];
  return 4 * other + place_of(topology, other, edge);
}

}  // namespace

std::vector<ShellFace> shell_faces(const Mesh& hull) {
  const Topology topology = build_topology(hull);
  std::vector<ShellFace> faces(hull.face_count());
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto id = static_cast<FaceId>(f);
    faces[f].across[3] = kInvalidId;
    for (std::size_t c = 0; c < 3; ++c) {
      const int corner = static_cast<int>(c);
      const Vec2& uv = hull.corner(hull.uvs, id, corner);
      faces[f].corner[c] = Vec4(hull.positions[hull.faces[f][c]], uv.x);
      faces[f].direction[c] = Vec4(hull.corner(hull.normals, id, corner), 1.0f - uv.y);
      faces[f].across[c] = beyond(topology, id, c);
    }
  }
  return faces;
}

}  // namespace limn
