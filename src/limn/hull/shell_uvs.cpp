#include "limn/hull/shell_uvs.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <optional>

namespace limn {

std::vector<Vec2> shell_uvs(const Mesh& mesh, const Shell& shell) {
  if (mesh.uvs.empty()) return {};
  std::vector<std::optional<Vec2>> found(shell.positions.size());
  for (FaceId face = 0; face < shell.faces.size(); ++face) {
    const FaceId source = shell.source_face[face];
    if (source == kInvalidId) continue;
    for (const VertexId v : shell.faces[face]) {
      for (int c = 0; c < 3; ++c) {
        // Corners are told by their places: a face may have been split.
        if (mesh.positions[mesh.faces[source][static_cast<std::size_t>(c)]] != shell.positions[v]) continue;
        const Vec2 uv = mesh.corner(mesh.uvs, source, c);
        if (found[v] && *found[v] != uv) return {};
        found[v] = uv;
      }
    }
  }
  std::vector<Vec2> uvs;
  for (const std::optional<Vec2>& uv : found) {
    if (!uv) return {};
    uvs.push_back(*uv);
  }
  return uvs;
}

void carry_uvs(std::span<const HullStep> steps, std::span<const Vec3> positions, std::vector<Vec2>& uvs) {
  std::vector<Vec3> places(positions.begin(), positions.end());
  for (const HullStep& step : steps) {
    if (step.kind == HullStep::Kind::kCut) {
      for (const VertexId v : {step.kept, step.removed, step.left}) {
        uvs.push_back(Vec2(uvs[v]));
        places.push_back(Vec3(places[v]));
      }
    }
    if (step.kind == HullStep::Kind::kMove) places[step.kept] = step.after;
    if (step.kind != HullStep::Kind::kCollapse) continue;
    const DVec3 from(places[step.kept]);
    const DVec3 edge = DVec3(places[step.removed]) - from;
    const double square = glm::dot(edge, edge);
    const double along = square > 0.0 ? std::clamp(glm::dot(DVec3(step.after) - from, edge) / square, 0.0, 1.0) : 0.0;
    const auto t = static_cast<float>(along);
    uvs[step.kept] = uvs[step.kept] * (1.0f - t) + uvs[step.removed] * t;
    places[step.kept] = step.after;
  }
}

}  // namespace limn
