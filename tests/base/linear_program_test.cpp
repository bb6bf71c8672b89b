#include "limn/base/linear_program.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <optional>
#include <vector>

#include "limn/base/random.h"

namespace limn {
namespace {

using Program = std::vector<HalfSpace>;

DVec3 direction(Random& random) {
  return glm::normalize(DVec3(random.direction()));
}

double worst_side(const Program& program, const DVec3& point) {
  double worst = 1e300;
  for (const HalfSpace& h : program)
    worst = std::min(worst, (glm::dot(h.normal, point) + h.offset) / glm::length(h.normal));
  return worst;
}

std::optional<DVec3> corner(const HalfSpace& a, const HalfSpace& b, const HalfSpace& c) {
  const double det = glm::dot(a.normal, glm::cross(b.normal, c.normal));
  if (std::abs(det) < 1e-9) return {};
  return -(a.offset * glm::cross(b.normal, c.normal) + b.offset * glm::cross(c.normal, a.normal) +
           c.offset * glm::cross(a.normal, b.normal)) /
         det;
}

/// The lowest of all corners that lie in every half-space; right for programs whose optimum is a corner.
std::optional<double> lowest_corner(const Program& program, const DVec3& cost) {
  std::optional<double> lowest;
  for (std::size_t i = 0; i < program.size(); ++i) {
    for (std::size_t j = i + 1; j < program.size(); ++j) {
      for (std::size_t k = j + 1; k < program.size(); ++k) {
        const std::optional<DVec3> point = corner(program[i], program[j], program[k]);
        if (!point || worst_side(program, *point) < -1e-9) continue;
        const double value = glm::dot(cost, *point);
        if (!lowest || value < *lowest) lowest = value;
      }
    }
  }
  return lowest;
}

/// A large cube: with it every feasible program has a lowest corner.
Program cube(double half) {
  Program program;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      DVec3 normal(0.0);
      normal[axis] = sign;
      program.push_back({normal, half});
    }
  }
  return program;
}

TEST(LinearProgram, FindsTheLowestOfAllCornersOrThatThereIsNone) {
  Random random(1);
  int feasible = 0;
  int infeasible = 0;
  for (int trial = 0; trial < 400; ++trial) {
    Program program = cube(10);
    const std::uint64_t extra = random.below(16);
    for (std::uint64_t i = 0; i < extra; ++i)
      program.push_back({direction(random) * random.uniform(0.1, 10), random.uniform(-4, 8)});
    const DVec3 cost = direction(random);
    const std::optional<double> lowest = lowest_corner(program, cost);
    const LinearProgramResult result = solve_linear_program(program, cost, {.seed = random.next()});
    ASSERT_EQ(result.outcome == LinearProgramOutcome::kOptimal, lowest.has_value()) << trial;
    ++(lowest ? feasible : infeasible);
    if (!lowest) continue;
    EXPECT_GT(worst_side(program, result.point), -1e-9) << trial;
    EXPECT_NEAR(glm::dot(cost, result.point), *lowest, 1e-8) << trial;
  }
  EXPECT_GT(feasible, 50);
  EXPECT_GT(infeasible, 50);
}

TEST(LinearProgram, TellsUnboundedFromBounded) {
  Random random(2);
  for (int trial = 0; trial < 200; ++trial) {
    // Planes through points of the unit sphere around the cost: bounded exactly when the cost is in their cone.
    Program program;
    const DVec3 normals[3] = {direction(random), direction(random), direction(random)};
    for (const DVec3& n : normals)
      program.push_back({n, random.uniform(-1, 1)});
    const DVec3 inside = glm::normalize(normals[0] + 0.5 * normals[1] + 0.7 * normals[2]);
    const DVec3 outside = glm::normalize(normals[0] - 0.5 * normals[1] + 0.7 * normals[2]);
    EXPECT_EQ(solve_linear_program(program, inside).outcome, LinearProgramOutcome::kOptimal);
    EXPECT_EQ(solve_linear_program(program, outside).outcome, LinearProgramOutcome::kUnbounded);
  }
  EXPECT_EQ(solve_linear_program({}, DVec3(1, 0, 0)).outcome, LinearProgramOutcome::kUnbounded);
}

TEST(LinearProgram, OfEqualOptimaTakesTheOneNearestToTheFrame) {
  // A slab's lower side, a wedge's bottom line, and no cost at all.
  const LinearProgramOptions options{.near = DVec3(3, 4, 5), .scale = 0.1};
  const Program slab = {{DVec3(0, 0, 2), -2}, {DVec3(0, 0, -1), 7}};
  const LinearProgramResult on_slab = solve_linear_program(slab, DVec3(0, 0, 1), options);
  EXPECT_LT(glm::distance(on_slab.point, DVec3(3, 4, 1)), 1e-12);
  EXPECT_EQ(on_slab.support.count, 1);
  const Program wedge = {{DVec3(1, 0, 1), 0}, {DVec3(-1, 0, 1), 0}};
  const LinearProgramResult in_wedge = solve_linear_program(wedge, DVec3(0, 0, 1), options);
  EXPECT_LT(glm::distance(in_wedge.point, DVec3(0, 4, 0)), 1e-12);
  EXPECT_EQ(in_wedge.support.count, 2);
  EXPECT_EQ(solve_linear_program(slab, DVec3(0.0), options).point, options.near);
}

TEST(LinearProgram, StandsDuplicateAndNearlyParallelHalfSpaces) {
  Random random(3);
  for (int trial = 0; trial < 2000; ++trial) {
    Program program = cube(2);
    const double spread = std::pow(10.0, -random.uniform(3, 9));
    for (int group = 0; group < 4; ++group) {
      const DVec3 n = direction(random);
      for (int i = 0; i < 6; ++i)
        program.push_back({glm::normalize(n + spread * direction(random)), random.below(2) == 0 ? 1.0 : 1.0 + spread});
      program.push_back(program.back());
    }
    const DVec3 cost = trial % 2 == 0 ? direction(random) : program[8].normal;
    const LinearProgramResult result = solve_linear_program(program, cost, {.seed = random.next()});
    const LinearProgramResult again = solve_linear_program(program, cost, {.seed = random.next()});
    ASSERT_EQ(result.outcome, LinearProgramOutcome::kOptimal) << trial;
    ASSERT_EQ(again.outcome, LinearProgramOutcome::kOptimal) << trial;
    EXPECT_GT(worst_side(program, result.point), -1e-10) << trial << " spread " << spread;
    EXPECT_NEAR(glm::dot(cost, result.point), glm::dot(cost, again.point), 1e-7) << trial << " spread " << spread;
  }
}

TEST(LinearProgram, SupportAloneGivesTheSameOptimumAndTheSeedOnlyTheOrder) {
  Random random(4);
  for (int trial = 0; trial < 100; ++trial) {
    Program program;
    for (int i = 0; i < 200; ++i)
      program.push_back({direction(random), random.uniform(0.5, 1.0)});
    const DVec3 cost = direction(random);
    const LinearProgramResult result = solve_linear_program(program, cost);
    ASSERT_EQ(result.outcome, LinearProgramOutcome::kOptimal);
    EXPECT_LT(glm::distance(solve_linear_program(program, cost, {.seed = 99}).point, result.point), 1e-9);
    Program kept;
    for (int i = 0; i < result.support.count; ++i)
      kept.push_back(program[result.support.index[static_cast<std::size_t>(i)]]);
    EXPECT_LT(glm::distance(solve_linear_program(kept, cost).point, result.point), 1e-9);
  }
}

TEST(LinearProgram, WorksFarFromTheOriginInAFrameOfItsOwn) {
  Random random(5);
  for (int trial = 0; trial < 50; ++trial) {
    const DVec3 far = direction(random) * 1e7;
    Program here;
    Program there;
    for (int i = 0; i < 20; ++i) {
      const DVec3 n = direction(random);
      const double d = random.uniform(0.5, 1.0);
      here.push_back({n, 1e-3 * d});
      there.push_back({n, 1e-3 * d - glm::dot(n, far)});
    }
    const DVec3 cost = direction(random);
    const DVec3 expected = solve_linear_program(here, cost, {.scale = 1e-3}).point;
    const DVec3 found = solve_linear_program(there, cost, {.near = far, .scale = 1e-3}).point - far;
    EXPECT_LT(glm::distance(found, expected), 1e-6);
  }
}

}  // namespace
}  // namespace limn
