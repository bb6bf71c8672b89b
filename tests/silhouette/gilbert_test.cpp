#include "limn/silhouette/sander/gilbert.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <vector>

#include "limn/base/random.h"

namespace limn {
namespace {

/// The axis of the smallest cone around unit vectors by trying every pair's and triple's: cos of its half angle, which
/// is the distance of the hull from the origin when positive.
double widest_cosine(const std::vector<DVec3>& normals) {
  std::vector<DVec3> axes = normals;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    for (std::size_t j = i + 1; j < normals.size(); ++j) {
      axes.push_back(normals[i] + normals[j]);
      for (std::size_t k = j + 1; k < normals.size(); ++k) {
        const DVec3 axis = glm::cross(normals[j] - normals[i], normals[k] - normals[i]);
        axes.push_back(glm::dot(axis, normals[i]) < 0 ? -axis : axis);
      }
    }
  }
  double widest = -1.0;
  for (const DVec3& axis : axes) {
    if (glm::length(axis) < 1e-12) continue;
    double least = 1.0;
    for (const DVec3& n : normals)
      least = std::min(least, glm::dot(n, axis) / glm::length(axis));
    widest = std::max(widest, least);
  }
  return widest;
}

std::vector<DVec3> normals_about(Random& random, int count, double spread) {
  const DVec3 middle(random.direction());
  std::vector<DVec3> normals;
  for (int i = 0; i < count; ++i)
    normals.push_back(glm::normalize(middle + spread * DVec3(random.direction())));
  return normals;
}

TEST(Gilbert, FindsTheAxisOfTheSmallestConeAroundTheNormals) {
  Random random(1);
  int inside = 0;
  for (int trial = 0; trial < 600; ++trial) {
    const double spread = std::pow(10.0, random.uniform(-6, 0.5));
    const std::vector<DVec3> normals = normals_about(random, 1 + static_cast<int>(random.below(14)), spread);
    const ClosestSimplex closest = closest_to_origin(normals);
    const double expected = widest_cosine(normals);
    ASSERT_EQ(closest.contains_origin, expected <= 1e-9) << trial;
    inside += closest.contains_origin ? 1 : 0;
    if (closest.contains_origin) continue;
    EXPECT_NEAR(glm::length(closest.point), expected, 1e-12) << trial;
    ASSERT_LE(closest.count, 3);
    // As the paper says, the largest angle is that to any normal of the closest simplex.
    for (int i = 0; i < closest.count; ++i) {
      const double to_corner =
          glm::dot(normals[closest.index[static_cast<std::size_t>(i)]], glm::normalize(closest.point));
      EXPECT_NEAR(to_corner, expected, 1e-9) << trial;
    }
  }
  EXPECT_GT(inside, 10);
}

TEST(Gilbert, AnyStartGivesTheSamePoint) {
  Random random(2);
  for (int trial = 0; trial < 100; ++trial) {
    const std::vector<DVec3> normals = normals_about(random, 50, 0.8);
    const ClosestSimplex from_first = closest_to_origin(normals);
    const std::uint32_t start[] = {static_cast<std::uint32_t>(random.below(50)),
                                   static_cast<std::uint32_t>(random.below(50)),
                                   static_cast<std::uint32_t>(random.below(50))};
    EXPECT_LT(glm::distance(closest_to_origin(normals, start).point, from_first.point), 1e-9);
  }
}

TEST(Gilbert, StandsRepeatedNormalsAndOppositeOnes) {
  const std::vector<DVec3> same(7, DVec3(0, 1, 0));
  EXPECT_EQ(closest_to_origin(same).point, DVec3(0, 1, 0));
  const std::vector<DVec3> opposite = {DVec3(0, 1, 0), DVec3(0, -1, 0), DVec3(1, 0, 0)};
  EXPECT_TRUE(closest_to_origin(opposite).contains_origin);
  const std::vector<DVec3> all = {DVec3(1, 0, 0),  DVec3(-1, 0, 0), DVec3(0, 1, 0),
                                  DVec3(0, -1, 0), DVec3(0, 0, 1),  DVec3(0, 0, -1)};
  EXPECT_TRUE(closest_to_origin(all).contains_origin);
  EXPECT_TRUE(closest_to_origin({}).contains_origin);
}

}  // namespace
}  // namespace limn
