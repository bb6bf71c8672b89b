#include "limn/refine/patch.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "limn/base/random.h"
#include "limn/mesh/normals.h"
#include "limn/refine/levels.h"

namespace limn {
namespace {

/// One face with random corners and normals near its own.
Mesh random_face(Random& random) {
  Mesh mesh;
  for (int i = 0; i < 3; ++i)
    mesh.positions.push_back(random.direction());
  mesh.faces = {{0, 1, 2}};
  const Vec3 normal = face_normals(mesh)[0];
  for (int i = 0; i < 3; ++i)
    mesh.normals.values.push_back(glm::normalize(normal + 0.4f * random.direction()));
  return mesh;
}

TEST(NineBasisFunctions, SumToOne) {
  Random random(1);
  double worst = 0;
  for (int n = 0; n < 100000; ++n) {
    const float u = static_cast<float>(random.uniform());
    const float v = static_cast<float>(random.uniform()) * (1 - u);
    double sum = 0;
    for (const float b : nine_basis_functions(u, v, 1 - u - v))
      sum += b;
    worst = std::max(worst, std::abs(sum - 1));
  }
  RecordProperty("worst_deviation_from_one", std::to_string(worst));
  EXPECT_LT(worst, 5e-7);
}

TEST(NineBasisFunctions, GiveThePatchWithTheMeanRule) {
  Random random(2);
  for (int n = 0; n < 1000; ++n) {
    const Mesh mesh = random_face(random);
    const Topology topology = build_topology(mesh);
    const Patch patch = make_patch(mesh, topology, edge_curves(mesh, topology), 0, CenterRule::kMean);
    const float u = static_cast<float>(random.uniform());
    const float v = static_cast<float>(random.uniform()) * (1 - u);
    const std::array<float, 9> b = nine_basis_functions(u, v, 1 - u - v);
    const Vec3 points[9] = {patch.b300, patch.b030, patch.b003, patch.b210, patch.b120,
                            patch.b021, patch.b012, patch.b102, patch.b201};
    Vec3 sum(0);
    for (std::size_t i = 0; i < 9; ++i)
      sum += points[i] * b[i];
    EXPECT_LT(glm::length(sum - evaluate_patch(patch, u, v, 1 - u - v)), 1e-6f);
  }
}

TEST(Patch, MeetsItsCornersExactlyAndItsEdgeCurvesClosely) {
  Random random(3);
  for (int n = 0; n < 200; ++n) {
    const Mesh mesh = random_face(random);
    const Topology topology = build_topology(mesh);
    const std::vector<EdgeCurve> curves = edge_curves(mesh, topology);
    const Patch patch = make_patch(mesh, topology, curves, 0, CenterRule::kPn);
    EXPECT_EQ(evaluate_patch(patch, 1, 0, 0), mesh.positions[0]);
    EXPECT_EQ(evaluate_patch(patch, 0, 1, 0), mesh.positions[1]);
    EXPECT_EQ(evaluate_patch(patch, 0, 0, 1), mesh.positions[2]);
    for (int c = 0; c < 3; ++c) {
      const EdgeId e = topology.face_edges[0][static_cast<std::size_t>(c)];
      const Edge& edge = topology.edges[e];
      for (int k = 0; k <= 8; ++k) {
        const Vec3 on_curve = evaluate_curve(mesh.positions[edge.v[0]], curves[e], mesh.positions[edge.v[1]], k, 3);
        float weights[3] = {0, 0, 0};
        const float t = static_cast<float>(k) / 8;
        weights[c] = topology.runs_forward(0, c) ? 1 - t : t;
        weights[(c + 1) % 3] = 1 - weights[c];
        EXPECT_LT(glm::length(on_curve - evaluate_patch(patch, weights[0], weights[1], weights[2])), 1e-6f);
      }
    }
  }
}

TEST(Patch, IsFlatOverAFlatFaceWithItsOwnNormals) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {3, 0, 0}, {0, 2, 0}};
  mesh.faces = {{0, 1, 2}};
  mesh.normals.values.assign(3, Vec3(0, 0, 1));
  const Topology topology = build_topology(mesh);
  for (const CenterRule rule : {CenterRule::kPn, CenterRule::kMean}) {
    const Patch patch = make_patch(mesh, topology, edge_curves(mesh, topology), 0, rule);
    const Vec3 middle = evaluate_patch(patch, 1.0f / 3, 1.0f / 3, 1.0f / 3);
    EXPECT_LT(glm::length(middle - Vec3(1, 2.0f / 3, 0)), 1e-6f);
  }
}

TEST(NormalPatch, MeetsItsCornersAndTurnsWithAnInflection) {
  const Vec3 p[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const Vec3 tilted = glm::normalize(Vec3(0.5f, 0, 1));
  const Vec3 n[3] = {tilted, tilted, tilted};
  const NormalPatch patch = make_normal_patch(p, n);
  EXPECT_LT(glm::length(evaluate_normal(patch, 1, 0, 0) - tilted), 1e-6f);
  // Equal tilted normals at both ends mean an S between them: linear interpolation would miss it.
  EXPECT_LT(evaluate_normal(patch, 0.5f, 0.5f, 0).x, 0.5f * tilted.x);
  EXPECT_NEAR(glm::length(evaluate_normal(patch, 0.2f, 0.3f, 0.5f)), 1.0f, 1e-6f);
}

/// A tent over the x axis: two faces with chosen normals at the shared edge's ends.
struct Tent {
  Mesh mesh;
  Topology topology;
  EdgeId ridge = 0;
};
Tent tent(const Vec3& left, const Vec3& right) {
  Tent t;
  t.mesh.positions = {{0, 0, 0}, {3, 0, 0}, {1, -1, -1}, {1, 1, -1}};
  t.mesh.faces = {{0, 2, 1}, {0, 1, 3}};
  t.mesh.normals.values = {left, right};
  t.mesh.normals.indices = {0, 0, 0, 1, 1, 1};
  t.topology = build_topology(t.mesh);
  while (t.topology.edge_class[t.ridge] != EdgeClass::kManifold)
    ++t.ridge;
  return t;
}

TEST(EdgeCurves, FollowTheSmoothRuleWhereNormalsAgree) {
  const Vec3 n = glm::normalize(Vec3(-0.6f, 0, 1));
  const Tent t = tent(n, n);
  const EdgeCurve curve = edge_curves(t.mesh, t.topology)[t.ridge];
  const Vec3 q(3, 0, 0);
  EXPECT_LT(glm::length(curve.c[0] - (q / 3.0f - n * glm::dot(q, n) / 3.0f)), 1e-6f);
  EXPECT_NEAR(glm::dot(curve.c[0], n), 0.0f, 1e-6f);
}

TEST(EdgeCurves, FollowTheSharpRuleWhereNormalsDiffer) {
  const Vec3 left = glm::normalize(Vec3(-0.3f, -1, 1));
  const Vec3 right = glm::normalize(Vec3(-0.3f, 1, 1));
  const Tent t = tent(left, right);
  const EdgeCurve curve = edge_curves(t.mesh, t.topology)[t.ridge];
  const Vec3 tangent = glm::normalize(glm::cross(left, right));
  EXPECT_LT(glm::length(curve.c[0] - tangent * glm::dot(Vec3(3, 0, 0), tangent) / 3.0f), 1e-6f);
  // In both tangent planes.
  EXPECT_NEAR(glm::dot(curve.c[0], left), 0.0f, 1e-6f);
  EXPECT_NEAR(glm::dot(curve.c[0], right), 0.0f, 1e-6f);
}

TEST(EdgeCurves, AreStraightWhereTheCreaseDoesNotRunAlongTheEdge) {
  const Tent t = tent(glm::normalize(Vec3(1, 0, 1)), glm::normalize(Vec3(-1, 0, 1)));
  const EdgeCurve curve = edge_curves(t.mesh, t.topology)[t.ridge];
  EXPECT_LT(glm::length(curve.c[0] - Vec3(1, 0, 0)), 1e-6f);
  EXPECT_LT(glm::length(curve.c[1] - Vec3(2, 0, 0)), 1e-6f);
}

TEST(EdgeCurves, AreTheSameWhicheverFaceComesFirst) {
  Random random(4);
  for (int i = 0; i < 100; ++i) {
    const Vec3 left = random.direction();
    const Vec3 right = i % 2 != 0 ? random.direction() : glm::normalize(left + 0.01f * random.direction());
    const Tent t = tent(left, right);
    Tent swapped = t;
    std::swap(swapped.mesh.faces[0], swapped.mesh.faces[1]);
    swapped.mesh.normals.indices = {1, 1, 1, 0, 0, 0};
    swapped.topology = build_topology(swapped.mesh);
    const EdgeCurve a = edge_curves(t.mesh, t.topology)[t.ridge];
    const EdgeCurve b = edge_curves(swapped.mesh, swapped.topology)[t.ridge];
    EXPECT_EQ(a.c[0], b.c[0]);
    EXPECT_EQ(a.c[1], b.c[1]);
  }
}

TEST(EvaluateCurve, GivesTheSameBitsForEqualFractionsAndItsEndsExactly) {
  Random random(5);
  for (int n = 0; n < 100; ++n) {
    const Vec3 p = random.direction() * 1e3f;
    const Vec3 q = random.direction();
    const EdgeCurve curve{{random.direction(), random.direction()}};
    EXPECT_EQ(evaluate_curve(p, curve, q, 0, 0), p);
    EXPECT_EQ(evaluate_curve(p, curve, q, 1, 0), q);
    for (int m = 0; m < kMaxLevel; ++m) {
      for (int k = 0; k <= 1 << m; ++k) {
        EXPECT_EQ(evaluate_curve(p, curve, q, k, m), evaluate_curve(p, curve, q, 2 * k, m + 1));
      }
    }
  }
}

}  // namespace
}  // namespace limn
