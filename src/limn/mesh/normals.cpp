#include "limn/mesh/normals.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>

#include "limn/base/parallel.h"

namespace limn {
namespace {

constexpr std::size_t kGrain = 8192;

DVec3 unit_normal(const Mesh& mesh, FaceId face) {
  const Triangle& t = mesh.faces[face];
  const DVec3 a = mesh.positions[t[0]];
  const DVec3 cross = glm::cross(DVec3(mesh.positions[t[1]]) - a, DVec3(mesh.positions[t[2]]) - a);
  const double length = glm::length(cross);
  return length > 0.0 ? cross / length : DVec3(0.0);
}

/// How much a face counts at its corner: the angle there, times the root of the area (docs/topology.md says why).
double corner_weight(const Mesh& mesh, FaceId face, std::size_t c) {
  const Triangle& t = mesh.faces[face];
  const DVec3 p = mesh.positions[t[c]];
  const DVec3 u = DVec3(mesh.positions[t[(c + 1) % 3]]) - p;
  const DVec3 v = DVec3(mesh.positions[t[(c + 2) % 3]]) - p;
  const double doubled_area = glm::length(glm::cross(u, v));
  return std::atan2(doubled_area, glm::dot(u, v)) * std::sqrt(doubled_area);
}

std::size_t longest_side(const Mesh& mesh, FaceId face) {
  const Triangle& t = mesh.faces[face];
  std::size_t longest = 0;
  double length = -1.0;
  for (std::size_t c = 0; c < 3; ++c) {
    const DVec3 side = DVec3(mesh.positions[t[(c + 1) % 3]]) - DVec3(mesh.positions[t[c]]);
    if (glm::dot(side, side) > length) {
      length = glm::dot(side, side);
      longest = c;
    }
  }
  return longest;
}

/// Each face's normal; a sliver without area takes that of the face across its longest side, in whose plane it lies,
/// so that a crease is seen through it (but not through a chain of slivers).
std::vector<DVec3> normals_seen_through_slivers(const Mesh& mesh, const Topology& topology) {
  std::vector<DVec3> normals(mesh.faces.size());
  parallel_for(normals.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f)
      normals[f] = unit_normal(mesh, static_cast<FaceId>(f));
  });
  for (std::size_t f = 0; f < normals.size(); ++f) {
    if (normals[f] != DVec3(0.0) || topology.face_edges[f][0] == kInvalidId) continue;
    const EdgeId across = topology.face_edges[f][longest_side(mesh, static_cast<FaceId>(f))];
    const Edge& edge = topology.edges[across];
    const FaceId other = edge.face[0] == f ? edge.face[1] : edge.face[0];
    if (topology.edge_class[across] == EdgeClass::kManifold) normals[f] = unit_normal(mesh, other);
  }
  return normals;
}

/// Corners joined into the smooth fans they belong to; a fan is named by its lowest corner.
class Fans {
 public:
  explicit Fans(std::size_t corners) : parent_(corners) { std::iota(parent_.begin(), parent_.end(), 0u); }
  std::uint32_t root(std::uint32_t corner) {
    while (parent_[corner] != corner)
      corner = parent_[corner] = parent_[parent_[corner]];
    return corner;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = root(a);
    b = root(b);
    if (a != b) parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

std::uint32_t corner_at(const Topology& topology, FaceId face, VertexId vertex) {
  const Triangle& t = topology.faces[face];
  return 3 * face + (t[0] == vertex ? 0u : t[1] == vertex ? 1u : 2u);
}

Fans smooth_fans(const Topology& topology, const std::vector<DVec3>& normals, double cos_crease) {
  Fans fans(3 * topology.face_count());
  for (std::size_t e = 0; e < topology.edge_count(); ++e) {
    if (topology.edge_class[e] != EdgeClass::kManifold) continue;
    const Edge& edge = topology.edges[e];
    if (glm::dot(normals[edge.face[0]], normals[edge.face[1]]) < cos_crease) continue;
    for (const VertexId v : edge.v)
      fans.join(corner_at(topology, edge.face[0], v), corner_at(topology, edge.face[1], v));
  }
  return fans;
}

}  // namespace

std::vector<Vec3> face_normals(const Mesh& mesh) {
  std::vector<Vec3> normals(mesh.faces.size());
  parallel_for(normals.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f)
      normals[f] = Vec3(unit_normal(mesh, static_cast<FaceId>(f)));
  });
  return normals;
}

CornerAttribute<Vec3> crease_normals(const Mesh& mesh, const Topology& topology, float crease_angle_rad) {
  constexpr float kPi = 3.14159265f;
  // Rounding must not make a crease of two faces in one plane, nor of opposite ones when everything is to be smooth.
  const double cos_crease = crease_angle_rad >= kPi ? -2.0 : std::cos(static_cast<double>(crease_angle_rad)) - 1e-12;
  const std::vector<DVec3> normals = normals_seen_through_slivers(mesh, topology);
  Fans fans = smooth_fans(topology, normals, cos_crease);

  CornerAttribute<Vec3> result;
  const std::size_t corners = 3 * mesh.faces.size();
  result.indices.resize(corners);
  std::vector<DVec3> sums;
  std::vector<double> weights;
  for (std::uint32_t corner = 0; corner < corners; ++corner) {
    const std::uint32_t root = fans.root(corner);
    if (root == corner) {
      result.indices[corner] = static_cast<std::uint32_t>(sums.size());
      sums.emplace_back(0.0);
      weights.push_back(0.0);
    } else {
      result.indices[corner] = result.indices[root];
    }
    const double weight = corner_weight(mesh, corner / 3, corner % 3);
    sums[result.indices[corner]] += weight * normals[corner / 3];
    weights[result.indices[corner]] += weight;
  }
  result.values.resize(sums.size());
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const double length = glm::length(sums[i]);
    result.values[i] = length > 1e-12 * weights[i] ? Vec3(sums[i] / length) : Vec3(0);
  }
  // A fan that cancels out (a sheet folded onto itself, a face without area) takes its face's normal, or any.
  for (std::uint32_t corner = 0; corner < corners; ++corner) {
    Vec3& normal = result.values[result.indices[corner]];
    if (normal == Vec3(0)) normal = Vec3(normals[corner / 3]);
  }
  for (Vec3& normal : result.values) {
    if (normal == Vec3(0)) normal = Vec3(0, 0, 1);
  }
  return result;
}

}  // namespace limn
