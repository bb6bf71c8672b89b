// The tree against testing every face: nearest points and first hits.
#include "limn/bake/face_tree.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "limn/base/parallel.h"
#include "limn/base/random.h"
#include "limn/mesh/face_area.h"

#include "bake/shapes.h"
#include "support/stable.h"

namespace limn::bake_detail {
namespace {

DVec3 point_of(const Mesh& mesh, const FacePoint& at) {
  const Triangle& t = mesh.faces[at.face];
  return DVec3(mesh.positions[t[0]]) * (1.0 - double(at.u) - double(at.v)) +
         DVec3(mesh.positions[t[1]]) * double(at.u) + DVec3(mesh.positions[t[2]]) * double(at.v);
}

double segment_distance(const DVec3& p, const DVec3& a, const DVec3& b) {
  const DVec3 d = b - a;
  const double length = glm::dot(d, d);
  const double t = length > 0.0 ? std::clamp(glm::dot(p - a, d) / length, 0.0, 1.0) : 0.0;
  return glm::length(p - a - t * d);
}

double face_distance(const Mesh& mesh, FaceId face, const DVec3& p) {
  const Triangle& t = mesh.faces[face];
  const DVec3 a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]);
  const DVec3 n = glm::cross(b - a, c - a);
  double best = std::min({segment_distance(p, a, b), segment_distance(p, b, c), segment_distance(p, c, a)});
  const bool inside = glm::dot(n, n) > 0.0 && glm::dot(glm::cross(b - a, p - a), n) >= 0.0 &&
                      glm::dot(glm::cross(c - b, p - b), n) >= 0.0 && glm::dot(glm::cross(a - c, p - c), n) >= 0.0;
  if (inside) best = std::min(best, std::abs(glm::dot(p - a, n)) / glm::length(n));
  return best;
}

double mesh_distance(const Mesh& mesh, const DVec3& p) {
  double best = 1e300;
  for (FaceId face = 0; face < mesh.faces.size(); ++face)
    best = std::min(best, face_distance(mesh, face, p));
  return best;
}

void expect_closest(const Mesh& mesh, const char* name, int points, std::uint64_t seed) {
  const FaceTree tree(mesh.positions, mesh.faces);
  const Bounds bounds = face_bounds(mesh);
  const double size = std::max<double>(bounds.diagonal(), glm::length(DVec3(bounds.center())));
  Random random(seed);
  FacePoint hint;
  for (int i = 0; i < points; ++i) {
    const Vec3 p =
        bounds.center() + static_cast<float>(random.uniform(0.0, 0.9) * bounds.diagonal()) * random.direction();
    const double expected = mesh_distance(mesh, DVec3(p));
    for (const FacePoint& start : {FacePoint{}, hint}) {
      const FacePoint found = tree.closest(p, start);
      ASSERT_LT(found.face, mesh.faces.size()) << name;
      ASSERT_NEAR(found.distance, expected, 2e-6 * size) << name << " point " << i;
      ASSERT_NEAR(glm::length(point_of(mesh, found) - DVec3(p)), expected, 2e-6 * size) << name << " point " << i;
      ASSERT_GE(found.u, 0.0f);
      ASSERT_GE(found.v, 0.0f);
      ASSERT_LE(found.u + found.v, 1.000001f);
      hint = found;
    }
  }
}

TEST(FaceTree, FindsTheNearestPointAsTestingEveryFaceDoes) {
  expect_closest(test::shape(Shape::kKnot, 3000), "knot", 300, 1);
  expect_closest(test::shape(Shape::kTerrain, 2000), "terrain", 300, 2);
  expect_closest(test::sphere(20), "icosahedron", 300, 3);
}

TEST(FaceTree, FindsTheNearestPointOfAwkwardMeshes) {
  for (const test::StableMesh& awkward : test::awkward_meshes()) {
    const Bounds bounds = face_bounds(awkward.mesh);
    // Coordinates are near 1 by contract.
    if (awkward.mesh.faces.empty() || bounds.diagonal() > 1e6 || bounds.diagonal() < 1e-6) continue;
    expect_closest(awkward.mesh, awkward.name.c_str(), 50, 4);
  }
}

TEST(FaceTree, CopesWithFacesOnEachOther) {
  Mesh mesh;
  mesh.positions = {Vec3(0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0.5f)};
  for (int i = 0; i < 10000; ++i)
    mesh.faces.push_back(i % 3 == 0 ? Triangle{3, 3, 3} : Triangle{0, 1, 2});
  expect_closest(mesh, "heap", 3, 5);
}

double hit_distance(const Mesh& mesh, FaceId face, const DVec3& origin, const DVec3& direction) {
  const Triangle& t = mesh.faces[face];
  const DVec3 a(mesh.positions[t[0]]), e1 = DVec3(mesh.positions[t[1]]) - a, e2 = DVec3(mesh.positions[t[2]]) - a;
  const DVec3 across = glm::cross(direction, e2);
  const double determinant = glm::dot(e1, across);
  if (determinant == 0.0) return 1e300;
  const double u = glm::dot(origin - a, across) / determinant;
  const double v = glm::dot(direction, glm::cross(origin - a, e1)) / determinant;
  const double distance = glm::dot(e2, glm::cross(origin - a, e1)) / determinant;
  return u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance >= 0.0 ? distance : 1e300;
}

TEST(FaceTree, FindsTheFirstHitAsTestingEveryFaceDoes) {
  const Mesh mesh = test::shape(Shape::kKnot, 3000);
  const FaceTree tree(mesh.positions, mesh.faces);
  Random random(7);
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 origin = 2.0f * random.direction();
    // Every fourth along an axis: a direction with zeros.
    Vec3 direction = glm::normalize(static_cast<float>(random.uniform()) * random.direction() - origin);
    if (i % 4 == 0) direction = Vec3(origin.x > 0 ? -1 : 1, 0, 0);
    double expected = 1e300;
    for (FaceId face = 0; face < mesh.faces.size(); ++face)
      expected = std::min(expected, hit_distance(mesh, face, DVec3(origin), DVec3(direction)));
    const TreeRay ray{origin, direction, 100.0f};
    const FacePoint found = tree.first_hit(ray);
    ASSERT_EQ(found.face != kInvalidId, expected < 1e300) << i;
    ASSERT_EQ(tree.meets_any(ray), expected < 1e300) << i;
    if (expected >= 1e300) continue;
    ++hits;
    ASSERT_NEAR(found.distance, expected, 1e-5) << i;
    const TreeRay shorter{origin, direction, static_cast<float>(expected * 0.999)};
    ASSERT_EQ(tree.first_hit(shorter).face, kInvalidId) << i;
  }
  EXPECT_GT(hits, 300);
}

TEST(FaceTree, IsTheSameForAnyNumberOfThreads) {
  const Mesh mesh = test::shape(Shape::kKnot, 20000);
  const FaceTree many(mesh.positions, mesh.faces);
  const ThreadLimit one(1);
  const FaceTree single(mesh.positions, mesh.faces);
  Random random(8);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p = random.direction();
    const FacePoint a = many.closest(p), b = single.closest(p);
    ASSERT_EQ(a.face, b.face);
    ASSERT_EQ(a.u, b.u);
    ASSERT_EQ(a.distance, b.distance);
  }
}

}  // namespace
}  // namespace limn::bake_detail
