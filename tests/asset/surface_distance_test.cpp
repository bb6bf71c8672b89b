#include "limn/asset/surface_distance.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "limn/base/parallel.h"
#include "limn/base/random.h"
#include "limn/mesh/shapes.h"

#include "asset/stand_in.h"

namespace limn::test {
namespace {

using asset::distance_from;
using asset::SurfaceDistance;

bake_detail::FaceTree tree_of(const Mesh& mesh) {
  return {mesh.positions, mesh.faces};
}

/// The largest distance of many points of a surface.
double sampled(const Mesh& surface, const bake_detail::FaceTree& reference, int per_face) {
  Random random(9);
  double largest = 0.0;
  for (const Triangle& face : surface.faces) {
    for (int i = 0; i < per_face; ++i) {
      double u = random.uniform(), v = random.uniform();
      if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
      const DVec3 p = DVec3(surface.positions[face[0]]) * (1.0 - u - v) + DVec3(surface.positions[face[1]]) * u +
                      DVec3(surface.positions[face[2]]) * v;
      largest = std::max(largest, double{reference.closest(Vec3(p)).distance});
    }
  }
  return largest;
}

TEST(SurfaceDistance, OfParallelSquaresIsTheirDistance) {
  const Mesh low = *make_shape(Shape::kSheet, {.faces = 200});
  Mesh high = low;
  for (Vec3& p : high.positions)
    p.z += 0.25f;
  const SurfaceDistance distance = distance_from(high, tree_of(low));
  EXPECT_GE(distance.bound, 0.25 - 1e-6);
  EXPECT_LE(distance.bound, 0.25 * 1.21);
}

TEST(SurfaceDistance, IsFoundInsideFacesToo) {
  // A large triangle whose corners lie on the reference and whose middle hangs far above it.
  Mesh bowl = *make_shape(Shape::kIcosphere, {.faces = 5000});
  Mesh lid;
  lid.positions = {Vec3(1, 0, 0), Vec3(-0.5f, 0.866f, 0), Vec3(-0.5f, -0.866f, 0)};
  lid.faces = {{0, 1, 2}};
  const SurfaceDistance distance = distance_from(lid, tree_of(bowl));
  EXPECT_NEAR(distance.reached, 1.0, 0.2);
  EXPECT_GE(distance.bound, 0.995);
  EXPECT_LE(distance.bound, 1.21);
}

TEST(SurfaceDistance, MissesNoSmallHole) {
  // A sheet of cells with one missing under a large triangle, and another face that lies nearly as far off.
  Mesh sheet, above;
  constexpr int kCells = 20;
  for (int y = 0; y <= kCells; ++y) {
    for (int x = 0; x <= kCells; ++x)
      sheet.positions.emplace_back(static_cast<float>(x) / kCells, static_cast<float>(y) / kCells, 0.0f);
  }
  for (int y = 0; y < kCells; ++y) {
    for (int x = 0; x < kCells; ++x) {
      const auto v = static_cast<VertexId>(y * (kCells + 1) + x);
      if (x == 3 && y == 12) continue;
      sheet.faces.push_back({v, v + 1, v + kCells + 2});
      sheet.faces.push_back({v, v + kCells + 2, v + kCells + 1});
    }
  }
  above.positions = {Vec3(0, 0, 0),
                     Vec3(1, 0, 0),
                     Vec3(0, 1, 0),
                     Vec3(0.5f, 0.5f, 0.0205f),
                     Vec3(0.6f, 0.5f, 0.0205f),
                     Vec3(0.5f, 0.6f, 0.0205f)};
  above.faces = {{0, 1, 2}, {3, 4, 5}};
  EXPECT_GE(distance_from(above, tree_of(sheet)).bound, 0.025);  // from the middle of the hole to its rim
}

TEST(SurfaceDistance, BoundsEverySample) {
  for (const Shape shape : {Shape::kKnot, Shape::kAsteroid, Shape::kHoles3}) {
    const Mesh fine = *make_shape(shape, {.faces = 20000});
    const Mesh coarse = *make_shape(shape, {.faces = 1000});
    const bake_detail::FaceTree reference = tree_of(fine);
    const SurfaceDistance distance = distance_from(coarse, reference);
    const double samples = sampled(coarse, reference, 50);
    EXPECT_GE(distance.bound, samples);
    EXPECT_GE(distance.bound, distance.reached);
    EXPECT_LE(distance.bound, 1.5 * std::max(samples, distance.reached));
  }
}

TEST(SurfaceDistance, OfASurfaceFromItselfEnds) {
  const Mesh mesh = bumpy_sphere(1280);
  const SurfaceDistance distance = distance_from(mesh, tree_of(mesh));
  EXPECT_LE(distance.reached, 1e-6);
  EXPECT_LE(distance.bound, 0.03);  // pieces are that small when it ends
}

TEST(SurfaceDistance, DoesNotDependOnThreads) {
  const Mesh fine = bumpy_sphere(5120);
  const Mesh coarse = bumpy_sphere(320);
  const SurfaceDistance many = distance_from(coarse, tree_of(fine));
  const ThreadLimit one(1);
  const SurfaceDistance alone = distance_from(coarse, tree_of(fine));
  EXPECT_EQ(many.bound, alone.bound);
  EXPECT_EQ(many.reached, alone.reached);
}

}  // namespace
}  // namespace limn::test
