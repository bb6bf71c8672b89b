#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "limn/mesh/shapes/asteroid.h"
#include "limn/mesh/shapes/builders.h"
#include "limn/mesh/shapes/lattice.h"

namespace limn::procedural {
namespace {

/// The icosahedron with corners 0 and 11 at the poles, so that no face has a pole inside it.
constexpr std::size_t kCornerCount = 12;
constexpr VertexId kNorth = 0, kSouth = 11;

std::array<DVec3, kCornerCount> icosahedron_corners() {
  std::array<DVec3, kCornerCount> corners;
  corners[kNorth] = DVec3(0, 1, 0);
  corners[kSouth] = DVec3(0, -1, 0);
  const double y = 1 / std::sqrt(5.0), radius = 2 / std::sqrt(5.0);
  for (std::size_t k = 0; k < 5; ++k) {
    const double upper = 0.4 * std::numbers::pi * static_cast<double>(k), lower = upper + 0.2 * std::numbers::pi;
    corners[1 + k] = DVec3(radius * std::sin(upper), y, radius * std::cos(upper));
    corners[6 + k] = DVec3(radius * std::sin(lower), -y, radius * std::cos(lower));
  }
  return corners;
}

std::vector<Triangle> icosahedron_faces() {
  std::vector<Triangle> faces;
  for (VertexId k = 0; k < 5; ++k) {
    const VertexId next = (k + 1) % 5;
    faces.push_back({kNorth, 1 + k, 1 + next});
    faces.push_back({1 + k, 6 + k, 1 + next});
    faces.push_back({1 + next, 6 + k, 6 + next});
    faces.push_back({kSouth, 6 + next, 6 + k});
  }
  return faces;
}

/// Longitude and latitude; u grows to the right seen from outside and jumps behind the sphere, at -z.
Vec2 sphere_uv(const DVec3& d) {
  const double u = std::atan2(d.x, d.z) / (2 * std::numbers::pi) + 0.5;
  const double v = std::asin(std::clamp(d.y, -1.0, 1.0)) / std::numbers::pi + 0.5;
  return Vec2(static_cast<float>(u >= 1 ? 0 : u), static_cast<float>(v));
}

/// Splits the uvs where a face would run backwards across the whole picture: its left corners get u + 1. A pole has as
/// many uvs as faces, each midway between the other two corners of its face.
void split_sphere_uvs(Mesh& mesh) {
  std::vector<Vec2>& values = mesh.uvs.values;
  std::vector<std::uint32_t> shifted(values.size(), kInvalidId);
  const auto shift = [&](VertexId v) {
    if (shifted[v] == kInvalidId) {
      shifted[v] = static_cast<std::uint32_t>(values.size());
      values.push_back(values[v] + Vec2(1, 0));
    }
    return shifted[v];
  };
  mesh.uvs.indices.resize(3 * mesh.faces.size());
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    const Triangle& t = mesh.faces[face];
    std::uint32_t* indices = &mesh.uvs.indices[3 * face];
    const auto is_pole = [&](std::size_t c) { return t[c] == kNorth || t[c] == kSouth; };
    float highest = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      if (!is_pole(c)) highest = std::max(highest, values[t[c]].x);
    }
    for (std::size_t c = 0; c < 3; ++c)
      indices[c] = !is_pole(c) && highest - values[t[c]].x > 0.5f ? shift(t[c]) : t[c];
    for (std::size_t c = 0; c < 3; ++c) {
      if (!is_pole(c)) continue;
      const float u = 0.5f * (values[indices[(c + 1) % 3]].x + values[indices[(c + 2) % 3]].x);
      indices[c] = static_cast<std::uint32_t>(values.size());
      values.emplace_back(u, values[t[c]].y);
    }
  }
}

/// A surface given by its points over the unit sphere's. `point` maps a direction to position and normal.
template <class PointOver>
Mesh over_sphere(std::size_t faces, const PointOver& point) {
  const std::vector<Triangle> base = icosahedron_faces();
  const std::array<DVec3, kCornerCount> corners = icosahedron_corners();
  const TriangleLattice lattice(kCornerCount, base, nearest_frequency(faces, base.size()));
  Mesh mesh;
  mesh.faces = lattice.triangles();
  mesh.positions.resize(lattice.point_count());
  mesh.normals.values.resize(lattice.point_count());
  mesh.uvs.values.resize(lattice.point_count());
  lattice.for_each_point([&](VertexId index, const LatticePoint& at) {
    const DVec3 direction = glm::normalize(corners[at.corner[0]] * static_cast<double>(at.weight[0]) +
                                           corners[at.corner[1]] * static_cast<double>(at.weight[1]) +
                                           corners[at.corner[2]] * static_cast<double>(at.weight[2]));
    point(direction, mesh.positions[index], mesh.normals.values[index]);
    mesh.uvs.values[index] = sphere_uv(direction);
  });
  split_sphere_uvs(mesh);
  return mesh;
}

}  // namespace

Mesh icosphere(std::size_t faces) {
  return over_sphere(faces, [](const DVec3& direction, Vec3& position, Vec3& normal) {
    position = Vec3(direction);
    normal = position;
  });
}

Mesh asteroid(std::size_t faces, std::uint64_t seed) {
  const AsteroidSurface surface(seed);
  return over_sphere(faces, [&](const DVec3& direction, Vec3& position, Vec3& normal) {
    const SurfacePoint point = surface.over(direction);
    position = Vec3(point.position);
    normal = Vec3(point.normal);
  });
}

}  // namespace limn::procedural
