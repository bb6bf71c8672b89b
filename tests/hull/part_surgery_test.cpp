#include "limn/hull/part_surgery.h"

#include <algorithm>
#include <gtest/gtest.h>

#include "limn/base/random.h"
#include "limn/hull/progressive_hull.h"
#include "limn/hull/self_intersections.h"
#include "limn/hull/winding.h"
#include "limn/mesh/shapes.h"

#include "support/checks.h"

namespace limn {
namespace {

Mesh sphere_at(const Vec3& middle, float radius, bool inwards = false) {
  Mesh mesh = *make_shape(Shape::kIcosphere, {.faces = 320});
  for (Vec3& p : mesh.positions)
    p = middle + radius * p;
  if (inwards) {
    for (Triangle& face : mesh.faces)
      std::swap(face[1], face[2]);
  }
  return mesh;
}

void append(Mesh& mesh, const Mesh& other) {
  const auto first = static_cast<VertexId>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
  for (const Triangle& f : other.faces)
    mesh.faces.push_back({f[0] + first, f[1] + first, f[2] + first});
  mesh.normals = {};
  mesh.uvs = {};
}

TEST(PartSurgery, TunnelsCloseWhereFacesRunOut) {
  const Mesh mesh = *make_shape(Shape::kHoles3, {.faces = 3000});
  const Result<Hull> hull = build_hull(mesh, {.faces = 30, .keep_steps = true});
  ASSERT_TRUE(hull);
  EXPECT_TRUE(hull->report.reached_target);
  EXPECT_GT(hull->report.cuts, 0u);
  for (const Vec3& p : mesh.positions) {
    const auto winding = winding_number(hull->mesh.positions, hull->mesh.faces, p);
    EXPECT_TRUE(!winding.has_value() || *winding > 0);
  }
}

TEST(PartSurgery, SmallCavitiesAreFilledByOuterHullsAndKeptByInnerOnes) {
  Mesh mesh = sphere_at(Vec3(0), 1);
  append(mesh, sphere_at(Vec3(0.1f, 0, 0), 0.15f, true));
  const Result<Hull> outer = build_hull(mesh, {.faces = 60});
  ASSERT_TRUE(outer);
  EXPECT_EQ(outer->report.filled, 1u);
  EXPECT_EQ(winding_number(outer->mesh.positions, outer->mesh.faces, Vec3(0.1f, 0, 0)), 1);
  const Result<Hull> inner = build_hull(mesh, {.faces = 60, .side = HullSide::kInner});
  ASSERT_TRUE(inner);
  EXPECT_EQ(winding_number(inner->mesh.positions, inner->mesh.faces, Vec3(0.1f, 0, 0)), 0);
  EXPECT_EQ(winding_number(inner->mesh.positions, inner->mesh.faces, Vec3(-0.5f, 0, 0)), 1);
}

TEST(PartSurgery, LargeCavitiesStay) {
  Mesh mesh = sphere_at(Vec3(0), 1);
  append(mesh, sphere_at(Vec3(0), 0.9f, true));
  for (const HullSide side : {HullSide::kOuter, HullSide::kInner}) {
    const Result<Hull> hull = build_hull(mesh, {.faces = 160, .side = side});
    ASSERT_TRUE(hull);
    EXPECT_EQ(hull->report.filled, 0u);
    EXPECT_EQ(winding_number(hull->mesh.positions, hull->mesh.faces, Vec3(0.1f, 0.2f, 0)), 0);
  }
}

TEST(PartSurgery, PartsInsideOthersAreDroppedAndOthersStay) {
  Mesh mesh = sphere_at(Vec3(0), 1);
  append(mesh, sphere_at(Vec3(0.2f, 0.1f, 0), 0.2f));
  append(mesh, sphere_at(Vec3(3, 0, 0), 0.5f));
  const Result<Hull> hull = build_hull(mesh, {.faces = 80});
  ASSERT_TRUE(hull);
  EXPECT_EQ(hull->report.dropped, 1u);
  for (const Vec3& p : mesh.positions) {
    const auto winding = winding_number(hull->mesh.positions, hull->mesh.faces, p);
    EXPECT_TRUE(!winding.has_value() || *winding > 0);
  }
  EXPECT_EQ(winding_number(hull->mesh.positions, hull->mesh.faces, Vec3(3, 0, 0)), 1);
  EXPECT_EQ(winding_number(hull->mesh.positions, hull->mesh.faces, Vec3(0.2f, 0.1f, 0)), 1);
}

TEST(PartSurgery, TwoSpheresThatTouchWallsAreNotDroppedWhileTheyStickOut) {
  Mesh mesh = sphere_at(Vec3(0), 1);
  append(mesh, sphere_at(Vec3(0.9f, 0, 0), 0.3f));  // half of it outside
  const Result<Hull> hull = build_hull(mesh, {.faces = 60});
  ASSERT_TRUE(hull);
  EXPECT_EQ(winding_number(hull->mesh.positions, hull->mesh.faces, Vec3(1.15f, 0, 0)), 1);
}

TEST(PartSurgery, CutsChangeNoWindingNumber) {
  // A ring of three sides: its throat is a triangle of edges that is no face.
  const Mesh torus = *make_shape(Shape::kTorus, {.faces = 400});
  const Result<Hull> hull = build_hull(torus, {.faces = 8, .keep_steps = true});
  ASSERT_TRUE(hull);
  const auto cut = std::find_if(hull->steps.begin(), hull->steps.end(),
                                [](const HullStep& s) { return s.kind == HullStep::Kind::kCut; });
  ASSERT_NE(cut, hull->steps.end());
  RingSurface surface(hull->shell, false);
  for (auto step = hull->steps.begin(); step != cut; ++step)
    surface.apply(*step);
  std::vector<FaceId> ids;
  const std::vector<Triangle> before = surface.faces(ids);
  const std::vector<Vec3> places(surface.positions().begin(), surface.positions().end());
  surface.apply(*cut);
  const std::vector<Triangle> after = surface.faces(ids);
  EXPECT_EQ(after.size(), before.size() + 2);
  EXPECT_EQ(after.size(), surface.live_faces());
  Random random(1);
  for (int i = 0; i < 500; ++i) {
    const Vec3 p(random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5));
    EXPECT_EQ(winding_number(places, before, p), winding_number(surface.positions(), after, p));
  }
}

}  // namespace
}  // namespace limn
