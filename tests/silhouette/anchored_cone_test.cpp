#include "limn/silhouette/sander/anchored_cone.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <vector>

#include "limn/base/linear_program.h"
#include "limn/base/random.h"
#include "limn/mesh/shapes.h"
#include "limn/silhouette/sander/viewpoint_volume.h"

namespace limn {
namespace {

/// Float planes around a point, and what the cones are made of.
struct Patch {
  Mesh mesh;
  std::vector<Plane> planes;
  CullingFrame frame;
  std::vector<DVec3> normals;
  std::vector<double> offsets;

  FaceCluster cluster() const { return {.normals = normals, .offsets = offsets}; }
};

/// Triangles in the unit ball whose normals are about one direction, moved and scaled.
Patch random_patch(Random& random, double spread, float scale, const Vec3& move) {
  Patch patch;
  const DVec3 middle(random.direction());
  const std::uint64_t count = 1 + random.below(30);
  for (std::uint64_t f = 0; f < count; ++f) {
    const DVec3 n = glm::normalize(middle + spread * DVec3(random.direction()));
    const DVec3 u = glm::normalize(glm::cross(n, DVec3(random.direction())));
    const DVec3 v = glm::cross(n, u);
    const DVec3 at = DVec3(random.direction()) * random.uniform();
    const auto first = static_cast<VertexId>(patch.mesh.positions.size());
    for (const DVec3& corner : {at, at + 0.2 * u, at + 0.2 * v})
      patch.mesh.positions.push_back(Vec3(corner) * scale + move);
    patch.mesh.faces.push_back({first, first + 1, first + 2});
  }
  patch.planes = face_planes(patch.mesh);
  patch.frame = culling_frame(patch.mesh, patch.planes);
  for (const Plane& plane : patch.planes) {
    const FramedPlane framed = framed_plane(plane, patch.frame);
    patch.normals.push_back(framed.normal);
    patch.offsets.push_back(framed.offset);
  }
  return patch;
}

TEST(AnchoredCone, AnchorsAreThoseOfTheProgramsOverAllFaces) {
  Random random(1);
  int cones = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const Patch patch = random_patch(random, random.uniform(0.01, 0.9), 1, Vec3(0));
    const AnchoredCone cone = anchored_cone(patch.cluster());
    if (!cone.exists) continue;
    ++cones;
    std::vector<HalfSpace> front, back;
    for (std::size_t f = 0; f < patch.normals.size(); ++f) {
      front.push_back({patch.normals[f], patch.offsets[f]});
      back.push_back({-patch.normals[f], -patch.offsets[f]});
      EXPECT_GT(glm::dot(patch.normals[f], cone.axis), cone.sine - 1e-9);
      EXPECT_GT(glm::dot(patch.normals[f], cone.front_anchor) + patch.offsets[f], -1e-7);
      EXPECT_LT(glm::dot(patch.normals[f], cone.back_anchor) + patch.offsets[f], 1e-7);
    }
    const LinearProgramResult lowest = solve_linear_program(front, cone.axis);
    const LinearProgramResult highest = solve_linear_program(back, -cone.axis);
    EXPECT_NEAR(glm::dot(cone.axis, cone.front_anchor), glm::dot(cone.axis, lowest.point), 1e-7);
    EXPECT_NEAR(glm::dot(cone.axis, cone.back_anchor), glm::dot(cone.axis, highest.point), 1e-7);
  }
  EXPECT_GT(cones, 200);
}

TEST(AnchoredCone, HintsChangeNothing) {
  Random random(2);
  for (int trial = 0; trial < 100; ++trial) {
    const Patch patch = random_patch(random, 0.5, 1, Vec3(0));
    FaceCluster hinted = patch.cluster();
    const std::size_t count = patch.normals.size();
    hinted.axis_end = random.below(count + 1);
    hinted.front_end = hinted.axis_end + random.below(count - hinted.axis_end + 1);
    hinted.back_end = hinted.front_end + random.below(count - hinted.front_end + 1);
    const AnchoredCone plain = anchored_cone(patch.cluster());
    const AnchoredCone with_hints = anchored_cone(hinted);
    ASSERT_EQ(plain.exists, with_hints.exists);
    if (!plain.exists) continue;
    EXPECT_LT(glm::distance(plain.axis, with_hints.axis), 1e-9);
    EXPECT_NEAR(glm::dot(plain.axis, plain.front_anchor), glm::dot(plain.axis, with_hints.front_anchor), 1e-7);
  }
}

/// An eye that a careless test would judge wrongly: near an anchor or the rim of a cone, or anywhere.
Eye hard_eye(Random& random, const Patch& patch, const StoredCone& cone) {
  const double tiny = std::pow(10.0, -random.uniform(3, 9));
  const DVec3 axis = glm::normalize(DVec3(cone.scaled_normal) + DVec3(1e-30));
  const DVec3 side = glm::normalize(glm::cross(axis, DVec3(random.direction())));
  const double cosine = 1.0 / glm::length(DVec3(cone.scaled_normal));
  const DVec3 rim = cosine * axis + std::sqrt(std::max(0.0, 1 - cosine * cosine)) * side;
  const double sign = random.below(2) == 0 ? 1.0 : -1.0;
  const DVec3 on_rim = sign * (rim + tiny * DVec3(random.direction()));
  if (random.below(4) == 0) return {Vec3(on_rim), true};
  const DVec3 anchor(sign > 0 ? cone.front_anchor : cone.back_anchor);
  const double reach = std::pow(10.0, random.uniform(-8, 6));
  return {Vec3((anchor + reach * on_rim) / patch.frame.per_unit + patch.frame.center), false};
}

TEST(AnchoredCone, NeverCullsWhereFacesDisagreeAndAlmostAlwaysWhereItMay) {
  Random random(3);
  int culled = 0;
  int inside = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const float scales[] = {1, 1e-30f, 1e30f, 1e-41f};
    const Vec3 moves[] = {Vec3(0), Vec3(1000, -3000, 500), Vec3(1e6f, 0, 0)};
    const std::size_t scale = random.below(4);
    const Vec3 move = scale == 0 ? moves[random.below(3)] : Vec3(0);
    const Patch patch = random_patch(random, std::pow(10.0, -random.uniform(0, 7)), scales[scale], move);
    const AnchoredCone cone = anchored_cone(patch.cluster());
    const StoredCone stored = stored_cone(cone, patch.cluster(), patch.frame);
    for (int view = 0; view < 40; ++view) {
      const Eye eye = hard_eye(random, patch, stored);
      const FramedEye framed = framed_eye(eye, patch.frame);
      if (!framed.cullable || !culls(stored, framed)) continue;
      ++culled;
      for (const Plane& plane : patch.planes)
        ASSERT_EQ(faces_eye(plane, eye), faces_eye(patch.planes[0], eye)) << trial << " " << view;
    }
    if (!cone.exists || scale != 0 || move != Vec3(0)) continue;
    // Well inside the cone the stored one still culls: float anchors far away are that much less exact.
    const double inwards = 1e-4 + 2e-6 * glm::length(cone.front_anchor) / cone.sine;
    const FramedEye well_inside{cone.front_anchor + inwards * cone.axis, 1.0, true};
    EXPECT_TRUE(culls(stored, well_inside)) << trial << " sine " << cone.sine;
    ++inside;
  }
  EXPECT_GT(culled, 10000);
  EXPECT_GT(inside, 100);
}

TEST(AnchoredCone, OfNormalsAllAroundNeverCulls) {
  const Mesh mesh = *make_shape(Shape::kCube);
  Patch patch;
  patch.planes = face_planes(mesh);
  patch.frame = culling_frame(mesh, patch.planes);
  for (const Plane& plane : patch.planes) {
    patch.normals.push_back(framed_plane(plane, patch.frame).normal);
    patch.offsets.push_back(framed_plane(plane, patch.frame).offset);
  }
  const AnchoredCone cone = anchored_cone(patch.cluster());
  EXPECT_FALSE(cone.exists);
  const StoredCone stored = stored_cone(cone, patch.cluster(), patch.frame);
  Random random(4);
  for (int view = 0; view < 100; ++view)
    EXPECT_FALSE(culls(stored, framed_eye({random.direction() * 5.0f, false}, patch.frame)));
}

/// The probability by throwing viewpoints.
double thrown_probability(const AnchoredCone& cone, double radius, Random& random) {
  constexpr int kThrows = 200000;
  int outside = 0;
  for (int i = 0; i < kThrows; ++i) {
    const DVec3 p = DVec3(random.direction()) * (radius * std::cbrt(random.uniform()));
    const DVec3 front = p - cone.front_anchor;
    const DVec3 back = p - cone.back_anchor;
    const bool culled = glm::dot(front, cone.axis) >= glm::length(front) * cone.cosine ||
                        -glm::dot(back, cone.axis) >= glm::length(back) * cone.cosine;
    outside += culled ? 0 : 1;
  }
  return double{1.0} * outside / kThrows;
}

/// The same by a fine grid of directions.
double summed_probability(const AnchoredCone& cone, double radius) {
  constexpr int kSteps = 300;
  const DVec3 u = glm::normalize(glm::cross(cone.axis, DVec3(0.3, 0.5, 0.7)));
  const DVec3 v = glm::cross(cone.axis, u);
  const auto reach = [&](const DVec3& from, const DVec3& along) {
    const double b = glm::dot(from, along);
    return -b + std::sqrt(b * b + radius * radius - glm::dot(from, from));
  };
  double volume = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double z = cone.cosine + (1 - cone.cosine) * (i + 0.5) / kSteps;
    for (int j = 0; j < kSteps; ++j) {
      const double around = 6.283185307179586 * j / kSteps;
      const DVec3 along = z * cone.axis + std::sqrt(1 - z * z) * (std::cos(around) * u + std::sin(around) * v);
      volume += std::pow(reach(cone.front_anchor, along), 3) + std::pow(reach(cone.back_anchor, -along), 3);
    }
  }
  return 1.0 - volume * (1 - cone.cosine) / (2 * radius * radius * radius * kSteps * kSteps);
}

TEST(ViewpointVolume, IsTheShareOfRandomViewpointsInNeitherCone) {
  Random random(5);
  for (int trial = 0; trial < 12; ++trial) {
    AnchoredCone cone;
    cone.exists = true;
    cone.axis = DVec3(random.direction());
    cone.sine = random.uniform(0.1, 1.0);
    cone.cosine = std::sqrt(1 - cone.sine * cone.sine);
    cone.front_anchor = DVec3(random.direction()) + 0.5 * cone.axis;
    cone.back_anchor = DVec3(random.direction()) - 0.5 * cone.axis;
    for (const double radius : {3.0, 10.0})
      EXPECT_NEAR(survival_probability(cone, radius), thrown_probability(cone, radius, random), 6e-3);
    for (const double radius : {3.0, 10.0})
      EXPECT_NEAR(survival_probability(cone, radius), summed_probability(cone, radius), 1e-4);
    EXPECT_NEAR(survival_probability(cone, 1e9), cone.cosine, 1e-6);
    EXPECT_EQ(survival_probability(cone, std::numeric_limits<double>::infinity()), cone.cosine);
  }
  EXPECT_EQ(survival_probability({}, 10), 1.0);
}

}  // namespace
}  // namespace limn
