#include "limn/mesh/normals.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "limn/mesh/topology.h"

namespace limn {
namespace {

Mesh cube() {
  Mesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.positions.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
  mesh.faces = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

TEST(CreaseNormals, SplitACubeBelowARightAngleAndJoinItAbove) {
  const Mesh mesh = cube();
  const Topology topology = build_topology(mesh);
  const std::vector<Vec3> faces = face_normals(mesh);
  const CornerAttribute<Vec3> hard = crease_normals(mesh, topology, 1.5f);
  EXPECT_EQ(hard.values.size(), 24u);
  for (FaceId f = 0; f < 12; ++f) {
    for (int c = 0; c < 3; ++c)
      EXPECT_GT(glm::dot(mesh.corner(hard, f, c), faces[f]), 0.999999f);
  }
  const CornerAttribute<Vec3> soft = crease_normals(mesh, topology, 1.6f);
  EXPECT_EQ(soft.values.size(), 8u);
  for (FaceId f = 0; f < 12; ++f) {
    for (int c = 0; c < 3; ++c) {
      // Weighted by angles, the corner of a cube looks along its diagonal however its squares are cut.
      const Vec3 diagonal = glm::normalize(mesh.positions[mesh.faces[f][static_cast<std::size_t>(c)]]);
      EXPECT_GT(glm::dot(mesh.corner(soft, f, c), diagonal), 0.99999f);
    }
  }
}

TEST(CreaseNormals, SeeThroughASliverWithoutArea) {
  // Two right-angled flaps along x, joined by a sliver of collinear points on the shared edge.
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}, {1, 0, 1}};
  mesh.faces = {{0, 2, 3}, {0, 1, 2}, {1, 0, 4}, {2, 1, 4}};
  const Topology topology = build_topology(mesh);
  const CornerAttribute<Vec3> normals = crease_normals(mesh, topology, 0.5f);
  EXPECT_NEAR(std::abs(mesh.corner(normals, 0, 0).z), 1.0f, 1e-6f);
  EXPECT_NEAR(std::abs(mesh.corner(normals, 2, 0).y), 1.0f, 1e-6f);
  for (const Vec3& n : normals.values)
    EXPECT_NEAR(glm::length(n), 1.0f, 1e-6f);
}

TEST(FaceNormals, AreZeroWithoutAreaAndRightAtAnyScale) {
  for (const float scale : {1e-30f, 1.0f, 1e30f}) {
    Mesh mesh;
    mesh.positions = {Vec3(0), Vec3(scale, 0, 0), Vec3(0, scale, 0), Vec3(2 * scale, 0, 0)};
    mesh.faces = {{0, 1, 2}, {0, 1, 3}};
    EXPECT_EQ(face_normals(mesh)[0], Vec3(0, 0, 1));
    EXPECT_EQ(face_normals(mesh)[1], Vec3(0));
  }
}

}  // namespace
}  // namespace limn
