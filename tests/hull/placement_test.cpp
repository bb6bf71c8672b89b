#include "limn/hull/placement.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <optional>

#include "limn/base/linear_program.h"
#include "limn/base/random.h"

namespace limn {
namespace {

using Program = std::vector<HalfSpace>;

/// Normals about an axis, as around an edge; `spread` of 0 makes them all the same.
Program faces_around(Random& random, std::size_t count, double spread) {
  Program program;
  const DVec3 axis(random.direction());
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 normal(glm::normalize(axis + spread * DVec3(random.direction())));
    program.push_back({DVec3(normal), -double{static_cast<float>(random.uniform(-0.5, 0.5))}});
  }
  return program;
}

double lowest_side(const Program& program, const DVec3& x) {
  double lowest = 1e300;
  for (const HalfSpace& h : program)
    lowest = std::min(lowest, glm::dot(h.normal, x) + h.offset);
  return lowest;
}

/// The point of all half-spaces nearest to the target, by trying every triple, pair and single plane.
std::optional<DVec3> nearest_of_all(const Program& program, const DVec3& target) {
  std::optional<DVec3> nearest;
  const auto consider = [&](const DVec3& x) {
    if (!(lowest_side(program, x) > -1e-9)) return;
    if (!nearest || glm::distance(x, target) < glm::distance(*nearest, target)) nearest = x;
  };
  consider(target);
  for (std::size_t i = 0; i < program.size(); ++i) {
    const HalfSpace& a = program[i];
    consider(target - (glm::dot(a.normal, target) + a.offset) * a.normal / glm::dot(a.normal, a.normal));
    for (std::size_t j = i + 1; j < program.size(); ++j) {
      const HalfSpace& b = program[j];
      const DVec3 axis = glm::cross(a.normal, b.normal);
      const double square = glm::dot(axis, axis);
      if (square < 1e-16) continue;
      const DVec3 on_line = glm::cross(axis, a.offset * b.normal - b.offset * a.normal) / -square;
      consider(on_line + axis * (glm::dot(target - on_line, axis) / square));
      for (std::size_t k = j + 1; k < program.size(); ++k) {
        const HalfSpace& c = program[k];
        const double det = glm::dot(axis, c.normal);
        if (std::abs(det) < 1e-12) continue;
        consider(
            -(a.offset * glm::cross(b.normal, c.normal) + b.offset * glm::cross(c.normal, a.normal) + c.offset * axis) /
            det);
      }
    }
  }
  return nearest;
}

void load(const Program& program, PlacementPlanes& planes) {
  planes.clear();
  for (const HalfSpace& h : program)
    planes.add(Vec3(h.normal), static_cast<float>(-h.offset));
}

TEST(Placement, FindsTheNearestOfAllCornersEdgesAndFaces) {
  Random random(1);
  PlacementPlanes planes;
  std::size_t found = 0, impossible = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const Program program = faces_around(random, 3 + random.below(14), std::pow(10.0, random.uniform(-1, 1)));
    const DVec3 target = 5.0 * DVec3(random.direction());
    const std::optional<DVec3> oracle = nearest_of_all(program, target);
    load(program, planes);
    DVec3 x(0.0);
    const bool feasible = nearest_point(planes, target, x);
    if (oracle && glm::length(*oracle) < 30.0) {
      ASSERT_TRUE(feasible) << trial;
      EXPECT_GT(lowest_side(program, x), -1e-5) << trial;
      EXPECT_LE(glm::distance(x, target), glm::distance(*oracle, target) * (1 + 1e-4)) << trial;
      ++found;
    } else if (!oracle && feasible) {
      // What no corner held to 1e-9 may be held to the tolerance.
      EXPECT_GT(lowest_side(program, x), -1e-4 * std::max(1.0, glm::length(x))) << trial;
    } else {
      ++impossible;
    }
  }
  EXPECT_GT(found, 1000u);
  EXPECT_GT(impossible, 100u);
}

TEST(Placement, FarTargetsGiveTheLinearProgramsOptimum) {
  Random random(2);
  PlacementPlanes planes;
  for (int trial = 0; trial < 300; ++trial) {
    const Program program = faces_around(random, 8, 0.5);
    DVec3 gradient(0.0);
    for (const HalfSpace& h : program)
      gradient += h.normal;
    gradient = glm::normalize(gradient);
    const LinearProgramResult optimum = solve_linear_program(program, gradient);
    ASSERT_EQ(optimum.outcome, LinearProgramOutcome::kOptimal);
    if (glm::length(optimum.point) > 5.0) continue;
    load(program, planes);
    DVec3 x(0.0);
    ASSERT_TRUE(nearest_point(planes, -1e3 * gradient, x));
    EXPECT_GT(lowest_side(program, x), -1e-5);
    EXPECT_LT(glm::dot(gradient, x), glm::dot(gradient, optimum.point) + 0.02) << trial;
  }
}

TEST(Placement, OfAPlaneAlonePointsAreStraightAboveTheTarget) {
  PlacementPlanes planes;
  for (int copies = 0; copies < 9; ++copies)
    planes.add(Vec3(0, 0, 1), 0.25f);
  DVec3 x(0.0);
  ASSERT_TRUE(nearest_point(planes, DVec3(0, 0, -200), x));
  EXPECT_NEAR(x.x, 0.0, 1e-12);
  EXPECT_NEAR(x.y, 0.0, 1e-12);
  EXPECT_NEAR(x.z, 0.25, 1e-6);
}

TEST(Placement, SeesThatPlanesFaceEachOther) {
  PlacementPlanes planes;
  planes.add(Vec3(0, 0, 1), 0.1f);
  planes.add(Vec3(0, 0, -1), 0.1f);
  DVec3 x(0.0);
  EXPECT_FALSE(nearest_point(planes, DVec3(0.0), x));
}

TEST(Placement, FacesWithoutExtentHoldNothingBackAndVolumesAddUp) {
  const std::vector<FacePlane> faces = {{Vec3(0, 0, 1), 2.0f}, {Vec3(0), 0.0f}, {Vec3(1, 0, 0), 3.0f}};
  const std::vector<FaceId> ids = {0, 1, 2};
  PlacementPlanes planes;
  planes.set(faces, ids, 2, Vec3(0.5f, 0, 0), 0.0f);
  EXPECT_NEAR(glm::distance(planes.gradient(), DVec3(3, 0, 2)), 0.0, 1e-6);
  DVec3 x(0.0);
  ASSERT_TRUE(nearest_point(planes, DVec3(-5, 0, -5), x));
  EXPECT_NEAR(x.x, 0.5, 1e-5);
  EXPECT_NEAR(x.z, 0.0, 1e-5);
  EXPECT_NEAR(planes.volume3(DVec3(1.5, 0, 2), 0.0f), 2 * 2 + 3 * 1, 1e-5);
}

}  // namespace
}  // namespace limn
