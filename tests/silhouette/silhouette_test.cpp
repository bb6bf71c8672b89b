#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <map>

#include "limn/base/random.h"
#include "limn/mesh/normals.h"
#include "limn/silhouette/brute.h"
#include "limn/silhouette/classes.h"
#include "limn/silhouette/silhouetteness.h"

#include "support/stable.h"

namespace limn {
namespace {

/// The definition, face by face from a map of edges: no topology, no arrays shared with the extractor.
std::vector<std::array<VertexId, 2>> silhouette_by_definition(const Mesh& mesh, const Topology& topology,
                                                              const Eye& eye) {
  std::map<std::array<VertexId, 2>, std::vector<bool>> facing;
  const std::vector<Plane> planes = face_planes(mesh);
  for (FaceId f = 0; f < mesh.faces.size(); ++f) {
    const Triangle t = {topology.weld[mesh.faces[f][0]], topology.weld[mesh.faces[f][1]],
                        topology.weld[mesh.faces[f][2]]};
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      facing[{std::min(t[c], t[(c + 1) % 3]), std::max(t[c], t[(c + 1) % 3])}].push_back(faces_eye(planes[f], eye));
    }
  }
  std::vector<std::array<VertexId, 2>> edges;
  for (const auto& [ends, sides] : facing) {
    if (sides.size() == 2 && sides[0] != sides[1]) edges.push_back(ends);
  }
  return edges;
}

Eye random_eye(Random& random, const Mesh& mesh) {
  const double radii[] = {0.4, 2.0, 50.0};
  const Bounds bounds = face_bounds(mesh);
  const double size = std::max(bounds.diagonal(), 1e-30);
  if (random.below(4) == 0) return {random.direction(), true};
  if (random.below(8) == 0 && !mesh.positions.empty())
    return {mesh.positions[random.below(mesh.positions.size())], false};
  return {Vec3(DVec3(bounds.empty() ? Vec3(0) : bounds.center()) +
               DVec3(random.direction()) * (size * radii[random.below(3)])),
          false};
}

TEST(SilhouetteBrute, EqualsTheDefinitionOnAwkwardMeshesFromManyEyes) {
  Random random(11);
  std::size_t found = 0;
  for (const test::StableMesh& item : test::awkward_meshes()) {
    const Topology topology = build_topology(item.mesh);
    const std::vector<Plane> planes = face_planes(item.mesh);
    std::vector<EdgeId> edges;
    for (int view = 0; view < 50; ++view) {
      const Eye eye = random_eye(random, item.mesh);
      extract_silhouette_brute(topology, planes, eye, edges);
      ASSERT_TRUE(std::is_sorted(edges.begin(), edges.end()));
      std::vector<std::array<VertexId, 2>> ends;
      for (const EdgeId e : edges)
        ends.push_back({topology.edges[e].v[0], topology.edges[e].v[1]});
      ASSERT_EQ(ends, silhouette_by_definition(item.mesh, topology, eye)) << item.name;
      found += edges.size();
    }
  }
  EXPECT_GT(found, 1000u);
}

TEST(SilhouetteBrute, HasEvenDegreeAtEveryVertexOfAClosedMesh) {
  Random random(12);
  for (const test::StableMesh& item : test::awkward_meshes()) {
    if (!item.closed) continue;
    const Topology topology = build_topology(item.mesh);
    const std::vector<Plane> planes = face_planes(item.mesh);
    std::vector<EdgeId> edges;
    for (int view = 0; view < 20; ++view) {
      extract_silhouette_brute(topology, planes, random_eye(random, item.mesh), edges);
      std::map<VertexId, int> degree;
      for (const EdgeId e : edges) {
        for (const VertexId v : topology.edges[e].v)
          ++degree[v];
      }
      for (const auto& [vertex, count] : degree)
        EXPECT_EQ(count % 2, 0) << item.name << " vertex " << vertex;
    }
  }
}

TEST(Facing, IsBackExactlyOnThePlaneAndForFacesWithoutArea) {
  EXPECT_FALSE(faces_eye({0, 0, 1, -1}, {Vec3(5, 5, 1), false}));
  EXPECT_TRUE(faces_eye({0, 0, 1, -1}, {Vec3(5, 5, 1.0001f), false}));
  EXPECT_FALSE(faces_eye({0, 0, 1, -1}, {Vec3(1, 0, 0), true}));
  EXPECT_FALSE(faces_eye({0, 0, 0, 0}, {Vec3(1, 2, 3), false}));
}

TEST(Classes, TellBoundaryCreaseAndNonManifoldApart) {
  // A tent of two faces over the x axis, 90° apart, and a third face on one of its sides.
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0.5f, -1, 0}, {0.5f, 0, -1}, {0.5f, -2, 0.5f}, {0.5f, -2, -0.5f}};
  mesh.faces = {{0, 2, 1}, {0, 1, 3}};
  const Topology tent = build_topology(mesh);
  const std::vector<Vec3> normals = face_normals(mesh);
  EXPECT_EQ(boundary_edges(tent).size(), 4u);
  EXPECT_EQ(crease_edges(tent, normals, 1.5f).size(), 1u);
  EXPECT_EQ(crease_edges(tent, normals, 1.6f).size(), 0u);
  mesh.faces.push_back({0, 1, 4});
  const Topology fin = build_topology(mesh);
  EXPECT_EQ(non_manifold_edges(fin).size(), 1u);
  EXPECT_EQ(crease_edges(fin, face_normals(mesh), 0.1f).size(), 0u);
}

/// Two faces over the x axis whose normals are theta apart, and an eye turned by phi out of the first face's plane.
struct Hinge {
  Mesh mesh;
  Eye eye;
};
Hinge hinge(float theta, float phi) {
  Hinge h;
  h.mesh.positions = {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, std::cos(theta), -std::sin(theta)}};
  h.mesh.faces = {{0, 2, 1}, {0, 1, 3}};
  // The first face lies in z = 0 and looks towards +z; seen from +y, turned by phi towards its front.
  h.eye = {Vec3(0, 100 * std::cos(phi), 100 * std::sin(phi)), false};
  return h;
}

TEST(Silhouetteness, FallsToZeroExactlyAcrossTheWedge) {
  constexpr float kPhi = 0.3f;
  for (const float theta : {0.1f, 0.5f, 1.2f}) {
    const auto alpha_at = [&](float phi) {
      const Hinge h = hinge(theta, phi);
      const Topology topology = build_topology(h.mesh);
      EdgeId shared = 0;
      while (topology.edge_class[shared] != EdgeClass::kManifold)
        ++shared;
      return edge_silhouetteness(h.mesh, topology, face_normals(h.mesh), h.eye, {Wedge::Rule::kAngle, kPhi})[shared];
    };
    EXPECT_EQ(alpha_at(-0.01f), 1.0f);
    EXPECT_GT(alpha_at(0.01f), 0.9f);
    EXPECT_LT(alpha_at(0.01f), 1.0f);
    EXPECT_GT(alpha_at(kPhi - 0.01f), 0.0f);
    EXPECT_LT(alpha_at(kPhi - 0.01f), 0.1f);
    EXPECT_EQ(alpha_at(kPhi + 0.01f), 0.0f);
  }
}

TEST(Silhouetteness, IsOneOnEverySilhouetteEdge) {
  Random random(5);
  for (const test::StableMesh& item : test::awkward_meshes()) {
    const Topology topology = build_topology(item.mesh);
    const std::vector<Plane> planes = face_planes(item.mesh);
    const std::vector<Vec3> normals = face_normals(item.mesh);
    std::vector<EdgeId> edges;
    for (int view = 0; view < 20; ++view) {
      const Eye eye = random_eye(random, item.mesh);
      extract_silhouette_brute(topology, planes, eye, edges);
      const std::vector<float> alpha = edge_silhouetteness(item.mesh, topology, normals, eye);
      // The two tests round differently: an eye within rounding of a plane may fall on either side of it.
      for (const EdgeId e : edges)
        EXPECT_GT(alpha[e], 0.98f) << item.name;
    }
  }
}

TEST(Silhouetteness, OfTheQuarterRuleIsTheWidthItself) {
  EXPECT_EQ(wedge_width({Wedge::Rule::kQuarter, 0.2f}, 0.3f, 0.9f), 0.25f);
  EXPECT_NEAR(wedge_width({Wedge::Rule::kAngle, 0.2f}, std::cos(0.5f), std::sin(0.5f)), std::sin(0.2f) * std::sin(0.7f),
              1e-6f);
  EXPECT_GT(wedge_width({Wedge::Rule::kAngle, 1.5f}, std::cos(3.0f), std::sin(3.0f)), 0.0f);
  EXPECT_EQ(silhouetteness(-1.0f, 0.1f), 1.0f);
  EXPECT_EQ(silhouetteness(0.05f, 0.1f), 0.5f);
  EXPECT_EQ(silhouetteness(0.2f, 0.1f), 0.0f);
}

}  // namespace
}  // namespace limn
