#include "support/checks.h"

#include <array>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <limits>
#include <map>
#include <set>
#include <vector>

namespace limn::test {
namespace {

using Place = std::array<float, 3>;

Place place_of(const Vec3& p) {
  return {p.x + 0.0f, p.y + 0.0f, p.z + 0.0f};  // adding 0 turns -0 into 0
}

std::array<Place, 3> places_of(const Mesh& mesh, const Triangle& t) {
  return {place_of(mesh.positions[t[0]]), place_of(mesh.positions[t[1]]), place_of(mesh.positions[t[2]])};
}

bool degenerate(const std::array<Place, 3>& p) {
  return p[0] == p[1] || p[1] == p[2] || p[2] == p[0];
}

/// Twice the face's area, along its normal.
DVec3 area_vector(const Mesh& mesh, const Triangle& t) {
  const DVec3 a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]);
  return glm::cross(b - a, c - a);
}

template <class T>
void expect_attribute_in_range(const CornerAttribute<T>& attribute, const Mesh& mesh, const char* name) {
  if (attribute.empty()) {
    EXPECT_TRUE(attribute.indices.empty()) << name;
    return;
  }
  if (attribute.indices.empty()) {
    EXPECT_EQ(attribute.values.size(), mesh.positions.size()) << name;
    return;
  }
  ASSERT_EQ(attribute.indices.size(), 3 * mesh.faces.size()) << name;
  for (const std::uint32_t i : attribute.indices)
    ASSERT_LT(i, attribute.values.size()) << name;
}

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

template <class T>
void expect_same_attribute(const CornerAttribute<T>& a, const CornerAttribute<T>& b, const char* name) {
  EXPECT_TRUE(same_bytes(a.values, b.values)) << name;
  EXPECT_TRUE(same_bytes(a.indices, b.indices)) << name;
}

}  // namespace

EdgeCounts count_edges(const Mesh& mesh) {
  struct Uses {
    std::size_t forward = 0, backward = 0;
  };
  std::map<std::array<Place, 2>, Uses> edges;
  for (const Triangle& t : mesh.faces) {
    const std::array<Place, 3> p = places_of(mesh, t);
    if (degenerate(p)) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      const Place &from = p[c], &to = p[(c + 1) % 3];
      if (from < to) {
        ++edges[{from, to}].forward;
      } else {
        ++edges[{to, from}].backward;
      }
    }
  }
  EdgeCounts counts;
  counts.edges = edges.size();
  for (const auto& [ends, uses] : edges) {
    const std::size_t faces = uses.forward + uses.backward;
    if (faces == 1) ++counts.boundary;
    if (faces == 2) ++(uses.forward == 1 ? counts.manifold : counts.inconsistent);
    if (faces > 2) ++counts.non_manifold;
  }
  return counts;
}

std::size_t count_used_positions(const Mesh& mesh) {
  std::set<Place> used;
  for (const Triangle& t : mesh.faces) {
    for (const Place& p : places_of(mesh, t))
      used.insert(p);
  }
  return used.size();
}

double signed_volume(const Mesh& mesh) {
  double six_times = 0;
  for (const Triangle& t : mesh.faces)
    six_times += glm::dot(DVec3(mesh.positions[t[0]]), area_vector(mesh, t));
  return six_times / 6;
}

double smallest_face_area(const Mesh& mesh) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const Triangle& t : mesh.faces)
    smallest = std::min(smallest, 0.5 * glm::length(area_vector(mesh, t)));
  return smallest;
}

double worst_normal_agreement(const Mesh& mesh) {
  double worst = 1;
  for (FaceId face = 0; face < mesh.faces.size(); ++face) {
    const DVec3 across = glm::normalize(area_vector(mesh, mesh.faces[face]));
    for (int c = 0; c < 3; ++c)
      worst = std::min(worst, glm::dot(across, DVec3(mesh.corner(mesh.normals, face, c))));
  }
  return worst;
}

void expect_well_formed(const Mesh& mesh) {
  for (const Triangle& t : mesh.faces) {
    for (const VertexId v : t)
      ASSERT_LT(v, mesh.positions.size());
  }
  for (const Vec3& p : mesh.positions)
    ASSERT_TRUE(is_finite(p));
  expect_attribute_in_range(mesh.normals, mesh, "normals");
  expect_attribute_in_range(mesh.uvs, mesh, "uvs");
  expect_attribute_in_range(mesh.colors, mesh, "colors");
  for (const Vec3& n : mesh.normals.values)
    ASSERT_NEAR(glm::length(DVec3(n)), 1.0, 1e-5);
  for (const Vec2& uv : mesh.uvs.values)
    ASSERT_TRUE(std::isfinite(uv.x) && std::isfinite(uv.y));
  if (!mesh.tags.empty()) {
    EXPECT_EQ(mesh.tags.size(), mesh.positions.size());
  }
  if (!mesh.face_materials.empty()) {
    EXPECT_EQ(mesh.face_materials.size(), mesh.faces.size());
  }
  for (const std::uint32_t material : mesh.face_materials)
    ASSERT_LT(material, mesh.materials.size());
}

void expect_closed(const Mesh& mesh) {
  const EdgeCounts counts = count_edges(mesh);
  EXPECT_GT(counts.edges, 0u);
  EXPECT_EQ(counts.boundary, 0u);
  EXPECT_EQ(counts.inconsistent, 0u);
  EXPECT_EQ(counts.non_manifold, 0u);
}

void expect_same_bits(const Mesh& a, const Mesh& b) {
  EXPECT_TRUE(same_bytes(a.positions, b.positions));
  EXPECT_TRUE(same_bytes(a.faces, b.faces));
  expect_same_attribute(a.normals, b.normals, "normals");
  expect_same_attribute(a.uvs, b.uvs, "uvs");
  expect_same_attribute(a.colors, b.colors, "colors");
  EXPECT_TRUE(same_bytes(a.tags, b.tags));
  EXPECT_TRUE(same_bytes(a.face_materials, b.face_materials));
  EXPECT_EQ(a.materials.size(), b.materials.size());
}

}  // namespace limn::test
