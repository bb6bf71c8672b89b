#include "reduce.h"

#include <cstdint>
#include <glm/geometric.hpp>
#include <meshoptimizer.h>
#include <span>
#include <vector>

#include "limn/mesh/normals.h"
#include "limn/mesh/topology.h"

namespace limn::bench {
namespace {

// The original's normals around each welded vertex, in the order of its corners.
struct VertexNormals {
  std::vector<std::uint32_t> offsets;  // one more than vertices
  std::vector<Vec3> normals;
};

bool is_degenerate(const Triangle& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

VertexNormals gather_normals(const Mesh& mesh, const Topology& topology, const CornerAttribute<Vec3>& normals) {
  VertexNormals gathered;
  gathered.offsets.assign(mesh.positions.size() + 1, 0);
  for (const Triangle& face : topology.faces) {
    for (const VertexId v : face)
      ++gathered.offsets[v + 1];
  }
  for (std::size_t v = 1; v < gathered.offsets.size(); ++v)
    gathered.offsets[v] += gathered.offsets[v - 1];
  gathered.normals.resize(3 * mesh.face_count());
  std::vector<std::uint32_t> next(gathered.offsets.begin(), gathered.offsets.end() - 1);
  for (FaceId f = 0; f < mesh.face_count(); ++f) {
    for (int c = 0; c < 3; ++c) {
      gathered.normals[next[topology.faces[f][static_cast<std::size_t>(c)]]++] = mesh.corner(normals, f, c);
    }
  }
  return gathered;
}

// The corners that remain, three a face, as welded vertices of the mesh.
std::vector<VertexId> simplify(const Mesh& mesh, const Topology& topology, std::size_t faces) {
  // meshoptimizer takes any other vertex at the same place, even an unused one, for the far side of a seam.
  std::vector<VertexId> vertices;
  std::vector<std::uint32_t> compact(mesh.positions.size());
  for (VertexId v = 0; v < mesh.positions.size(); ++v) {
    compact[v] = static_cast<std::uint32_t>(vertices.size());
    if (topology.weld[v] == v) vertices.push_back(v);
  }
  std::vector<Vec3> positions;
  for (const VertexId v : vertices)
    positions.push_back(mesh.positions[v]);
  std::vector<std::uint32_t> indices;
  for (const Triangle& face : topology.faces) {
    if (is_degenerate(face)) continue;
    for (const VertexId v : face)
      indices.push_back(compact[v]);
  }
  // Relative to the mesh's size: the number of faces is what stops it.
  constexpr float kAnyError = 1e6f;
  std::vector<std::uint32_t> reduced(indices.size());
  reduced.resize(meshopt_simplify(reduced.data(), indices.data(), indices.size(), &positions[0].x, positions.size(),
                                  sizeof(Vec3), 3 * faces, kAnyError, 0, nullptr));
  for (std::uint32_t& v : reduced)
    v = vertices[v];
  return reduced;
}

DVec3 face_direction(const Mesh& mesh, const Triangle& face) {
  const DVec3 a(mesh.positions[face[0]]), b(mesh.positions[face[1]]), c(mesh.positions[face[2]]);
  return glm::cross(b - a, c - a);
}

// The candidate that turns least from the direction; the first of equals.
Vec3 nearest_normal(std::span<const Vec3> candidates, const DVec3& direction) {
  Vec3 nearest = candidates.front();
  for (const Vec3& candidate : candidates) {
    if (glm::dot(DVec3(candidate), direction) > glm::dot(DVec3(nearest), direction)) nearest = candidate;
  }
  return nearest;
}

}  // namespace

Mesh reduce(const Mesh& mesh, std::size_t faces, float crease_angle_rad) {
  const Topology topology = build_topology(mesh);
  const VertexNormals originals = gather_normals(
      mesh, topology, mesh.normals.empty() ? crease_normals(mesh, topology, crease_angle_rad) : mesh.normals);
  const std::vector<VertexId> kept = simplify(mesh, topology, faces);
  Mesh reduced;
  std::vector<VertexId> renamed(mesh.positions.size(), kInvalidId);
  for (std::size_t i = 0; i < kept.size(); i += 3) {
    const Triangle original{kept[i], kept[i + 1], kept[i + 2]};
    const DVec3 direction = face_direction(mesh, original);
    Triangle face{};
    for (std::size_t c = 0; c < 3; ++c) {
      const VertexId v = original[c];
      if (renamed[v] == kInvalidId) {
        renamed[v] = static_cast<VertexId>(reduced.positions.size());
        reduced.positions.push_back(mesh.positions[v]);
      }
      face[c] = renamed[v];
      const std::span<const Vec3> around(originals.normals.data() + originals.offsets[v],
                                         originals.offsets[v + 1] - originals.offsets[v]);
      reduced.normals.indices.push_back(static_cast<std::uint32_t>(reduced.normals.values.size()));
      reduced.normals.values.push_back(nearest_normal(around, direction));
    }
    reduced.faces.push_back(face);
  }
  return reduced;
}

}  // namespace limn::bench
