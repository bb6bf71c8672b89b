#include "limn/hull/progressive_hull.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "limn/base/orient3d.h"
#include "limn/base/parallel.h"
#include "limn/base/random.h"
#include "limn/hull/self_intersections.h"
#include "limn/hull/winding.h"
#include "limn/mesh/shapes.h"

#include "support/checks.h"
#include "support/mesh_bits.h"
#include "support/stable.h"

namespace limn {
namespace {

Hull must_build(const Mesh& mesh, const HullOptions& options) {
  Result<Hull> hull = build_hull(mesh, options);
  EXPECT_TRUE(hull) << format_error(hull.error());
  return hull ? std::move(*hull) : Hull{};
}

/// Points just inside the surface, and inside its whole: where the winding number is positive, exactly.
std::vector<Vec3> inside_points(const Shell& shell, std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < count; ++i) {
    const Triangle& face = shell.faces[random.below(shell.faces.size())];
    const DVec3 a(shell.positions[face[0]]), b(shell.positions[face[1]]), c(shell.positions[face[2]]);
    const double s = random.uniform(), t = random.uniform() * (1 - s);
    const DVec3 normal = glm::cross(b - a, c - a);
    const double depth = std::pow(10.0, random.uniform(-6, -1)) / std::sqrt(std::max(glm::length(normal), 1e-300));
    const Vec3 point(a + s * (b - a) + t * (c - a) - depth * normal);
    const auto winding = winding_number(shell.positions, shell.faces, point);
    if (winding.has_value() && *winding > 0) points.push_back(point);
  }
  return points;
}

/// How many of the points the hull does not enclose.
std::size_t count_outside(const std::vector<Vec3>& points, const Mesh& hull) {
  std::size_t outside = 0;
  for (const Vec3& p : points) {
    // A point on the surface is enclosed, too: then there is no number.
    const auto winding = winding_number(hull.positions, hull.faces, p);
    outside += winding.has_value() && *winding <= 0 ? 1 : 0;
  }
  return outside;
}

Mesh mesh_of(const Shell& shell) {
  Mesh mesh;
  mesh.positions = shell.positions;
  mesh.faces = shell.faces;
  return mesh;
}

Mesh scaled(Mesh mesh, float scale) {
  for (Vec3& p : mesh.positions)
    p *= scale;
  return mesh;
}

TEST(ProgressiveHull, ReachesItsTargetAndEnclosesEveryVertexAndPointInside) {
  for (const Shape shape : {Shape::kKnot, Shape::kHoles3, Shape::kAsteroid}) {
    const Mesh mesh = *make_shape(shape, {.faces = 4000});
    for (const std::size_t faces : {std::size_t{400}, std::size_t{1000}}) {
      const Hull hull = must_build(mesh, {.faces = faces});
      EXPECT_TRUE(hull.report.reached_target);
      EXPECT_LE(hull.mesh.faces.size(), faces);
      test::expect_well_formed(hull.mesh);
      EXPECT_GE(hull.report.volume_ratio, 1.0);
      EXPECT_LT(hull.report.volume_ratio, 2.0);
      EXPECT_GE(hull.report.worst_margin, 0.0);
      EXPECT_EQ(count_outside(inside_points(hull.shell, 200, 1), hull.mesh), 0u);
      EXPECT_EQ(count_outside(hull.shell.positions, hull.mesh), 0u);
    }
  }
}

TEST(ProgressiveHull, InnerHullsLieInside) {
  for (const Shape shape : {Shape::kKnot, Shape::kAsteroid}) {
    const Mesh mesh = *make_shape(shape, {.faces = 5000});
    const Hull hull = must_build(mesh, {.faces = 600, .side = HullSide::kInner});
    EXPECT_TRUE(hull.report.reached_target);
    EXPECT_LT(hull.report.volume_ratio, 1.0);
    EXPECT_GT(hull.report.volume_ratio, 0.5);
    EXPECT_GT(test::signed_volume(hull.mesh), 0.0);
    const Mesh shell = mesh_of(hull.shell);
    EXPECT_EQ(count_outside(hull.mesh.positions, shell), 0u);
    EXPECT_EQ(count_outside(inside_points({hull.mesh.positions, hull.mesh.faces, {}, {}, {}}, 300, 2), shell), 0u);
  }
}

TEST(ProgressiveHull, EveryStepIsCertifiedAgainWhenTheStepsAreRepeated) {
  const Mesh mesh = *make_shape(Shape::kAsteroid, {.faces = 4000});
  const Hull hull = must_build(mesh, {.faces = 100, .keep_steps = true});
  ASSERT_EQ(hull.steps.size(), hull.report.collapses);
  std::vector<Vec3> positions = hull.shell.positions;
  std::vector<Triangle> faces = hull.shell.faces;
  for (const HullStep& step : hull.steps) {
    ASSERT_EQ(step.kind, HullStep::Kind::kCollapse);
    std::vector<Triangle> next;
    for (Triangle face : faces) {
      int ends = 0;
      for (const VertexId v : face)
        ends += v == step.kept || v == step.removed ? 1 : 0;
      if (ends > 0) {
        ASSERT_GE(orient3d(positions[face[0]], positions[face[1]], positions[face[2]], step.after), 0);
      }
      std::replace(face.begin(), face.end(), step.removed, step.kept);
      if (ends < 2) next.push_back(face);
    }
    ASSERT_EQ(next.size() + 2, faces.size());
    faces = std::move(next);
    positions[step.kept] = step.after;
  }
  ASSERT_EQ(faces.size(), hull.mesh.faces.size());
  for (FaceId f = 0; f < faces.size(); ++f) {
    for (const VertexId v : hull.mesh.faces[f])
      EXPECT_NE(std::find(faces[f].begin(), faces[f].end(), hull.shell_vertex[v]), faces[f].end());
  }
}

TEST(ProgressiveHull, PowersOfTwoScaleTheHullExactlyAndOtherScalesNearly) {
  const Mesh mesh = *make_shape(Shape::kKnot, {.faces = 4000});
  const Hull hull = must_build(mesh, {.faces = 500});
  const Hull twin = must_build(scaled(mesh, 0x1.0p-30f), {.faces = 500});
  EXPECT_TRUE(test::same_bits(hull.mesh.faces, twin.mesh.faces));
  EXPECT_TRUE(test::same_bits(scaled(hull.mesh, 0x1.0p-30f).positions, twin.mesh.positions));
  for (const float scale : {1e-3f, 1e3f}) {
    const Hull other = must_build(scaled(mesh, scale), {.faces = 500});
    EXPECT_TRUE(other.report.reached_target);
    EXPECT_NEAR(other.report.volume_ratio, hull.report.volume_ratio, 0.02);
  }
}

TEST(ProgressiveHull, SameBitsForAnyNumberOfThreads) {
  const Mesh mesh = *make_shape(Shape::kHoles3, {.faces = 8000});
  const Hull hull = must_build(mesh, {.faces = 300});
  const ThreadLimit one(1);
  const Hull again = must_build(mesh, {.faces = 300});
  test::expect_same_bits(hull.mesh, again.mesh);
}

TEST(ProgressiveHull, AwkwardMeshesGiveAHullOrAReason) {
  std::size_t hulls = 0;
  for (const test::StableMesh& awkward : test::awkward_meshes()) {
    for (const HullSide side : {HullSide::kOuter, HullSide::kInner}) {
      const Result<Hull> hull = build_hull(awkward.mesh, {.faces = 12, .side = side});
      if (!hull) {
        EXPECT_FALSE(hull.error().message.empty()) << awkward.name;
        EXPECT_FALSE(hull.error().remedy.empty()) << awkward.name;
        continue;
      }
      ++hulls;
      const Mesh shell = mesh_of(hull->shell);
      if (side == HullSide::kOuter) {
        EXPECT_EQ(count_outside(inside_points(hull->shell, 100, 3), hull->mesh), 0u) << awkward.name;
      } else if (!hull->mesh.faces.empty()) {
        const Shell inner{hull->mesh.positions, hull->mesh.faces, {}, {}, {}};
        EXPECT_EQ(count_outside(inside_points(inner, 100, 3), shell), 0u) << awkward.name;
      }
    }
  }
  EXPECT_GT(hulls, 10u);
}

TEST(ProgressiveHull, StrictHullsDoNotIntersectThemselves) {
  // Smooth hulls of a knot run into one another.
  const Mesh mesh = *make_shape(Shape::kKnot, {.faces = 4000});
  const Hull loose = must_build(mesh, {.faces = 150});
  const Hull strict = must_build(mesh, {.faces = 150, .strict = true});
  EXPECT_FALSE(self_intersections(loose.mesh.positions, loose.mesh.faces).empty());
  EXPECT_TRUE(self_intersections(strict.mesh.positions, strict.mesh.faces).empty());
  EXPECT_LT(strict.mesh.faces.size(), 1000u);
  EXPECT_EQ(count_outside(inside_points(strict.shell, 300, 4), strict.mesh), 0u);
}

TEST(ProgressiveHull, OriginalVerticesKnowWhatTheyBecamePartOf) {
  const Mesh mesh = *make_shape(Shape::kIcosphere, {.faces = 5000});
  const Hull hull = must_build(mesh, {.faces = 200});
  ASSERT_EQ(hull.vertex_of_original.size(), mesh.positions.size());
  std::vector<int> children(hull.mesh.positions.size(), 0);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const VertexId heir = hull.vertex_of_original[v];
    ASSERT_LT(heir, hull.mesh.positions.size());
    ++children[heir];
    EXPECT_LT(glm::distance(mesh.positions[v], hull.mesh.positions[heir]), 1.0f);
  }
  EXPECT_EQ(std::count(children.begin(), children.end(), 0), 0);
}

TEST(ProgressiveHull, StopsWhenAsked) {
  const Mesh mesh = *make_shape(Shape::kKnot, {.faces = 20000});
  int calls = 0;
  const Result<Hull> hull =
      build_hull(mesh, {.faces = 100, .progress = [&](std::string_view, double) { return ++calls < 3; }});
  ASSERT_FALSE(hull);
  EXPECT_EQ(hull.error().code, ErrorCode::kCancelled);
  EXPECT_EQ(calls, 3);
}

TEST(ProgressiveHull, RefusesFewerThanFourFaces) {
  const Result<Hull> hull = build_hull(*make_shape(Shape::kCube), {.faces = 3});
  ASSERT_FALSE(hull);
  EXPECT_EQ(hull.error().code, ErrorCode::kInvalidArgument);
}

}  // namespace
}  // namespace limn
