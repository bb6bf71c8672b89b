#include "limn/compare/distance_transform.h"

#include <algorithm>
#include <gtest/gtest.h>

#include "limn/base/parallel.h"
#include "limn/base/random.h"

namespace limn {
namespace {

std::vector<std::uint32_t> brute_force(const std::vector<std::uint8_t>& sites, int width, int height) {
  std::vector<std::uint32_t> result(sites.size(), kNoSite);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      std::uint32_t& nearest = result[static_cast<std::size_t>(y * width + x)];
      for (int sy = 0; sy < height; ++sy) {
        for (int sx = 0; sx < width; ++sx) {
          if (sites[static_cast<std::size_t>(sy * width + sx)] == 0) continue;
          nearest = std::min(nearest, static_cast<std::uint32_t>((x - sx) * (x - sx) + (y - sy) * (y - sy)));
        }
      }
    }
  }
  return result;
}

std::vector<std::uint8_t> random_sites(Random& random, int width, int height, double share) {
  std::vector<std::uint8_t> sites(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (std::uint8_t& s : sites)
    s = random.uniform() < share ? 1 : 0;
  return sites;
}

TEST(SquaredDistances, EqualBruteForceOnRandomPictures) {
  Random random(1);
  for (int picture = 0; picture < 600; ++picture) {
    const int width = 1 + static_cast<int>(random.below(30));
    const int height = 1 + static_cast<int>(random.below(30));
    const std::vector<std::uint8_t> sites =
        random_sites(random, width, height, random.uniform() * random.uniform() * 0.2);
    ASSERT_EQ(squared_distances(sites, width, height), brute_force(sites, width, height)) << "picture " << picture;
  }
}

TEST(SquaredDistances, EqualBruteForceOnLongThinPictures) {
  Random random(2);
  for (const auto& [width, height] : {std::pair{300, 2}, {2, 300}, {1, 1}, {1, 200}, {200, 1}}) {
    for (int picture = 0; picture < 20; ++picture) {
      const std::vector<std::uint8_t> sites = random_sites(random, width, height, 0.01);
      ASSERT_EQ(squared_distances(sites, width, height), brute_force(sites, width, height));
    }
  }
}

TEST(SquaredDistances, WithoutSitesAreAllNoSite) {
  const std::vector<std::uint8_t> none(35);
  EXPECT_EQ(squared_distances(none, 7, 5), std::vector<std::uint32_t>(35, kNoSite));
  EXPECT_TRUE(squared_distances({}, 0, 5).empty());
  EXPECT_TRUE(squared_distances({}, 5, 0).empty());
}

TEST(SquaredDistances, AreExactAcrossTheLargestPictures) {
  const int width = 16384, height = 3;
  std::vector<std::uint8_t> sites(static_cast<std::size_t>(width) * height);
  sites[0] = 1;
  const std::vector<std::uint32_t> squared = squared_distances(sites, width, height);
  EXPECT_EQ(squared.back(), 16383u * 16383u + 4u);
}

TEST(SquaredDistances, AreTheSameForAnyNumberOfThreads) {
  Random random(3);
  const std::vector<std::uint8_t> sites = random_sites(random, 700, 400, 0.001);
  const auto with_threads = [&](int threads) {
    const ThreadLimit limit(threads);
    return squared_distances(sites, 700, 400);
  };
  const auto expected = with_threads(1);
  for (const int threads : {2, 5})
    EXPECT_EQ(with_threads(threads), expected) << threads;
}

}  // namespace
}  // namespace limn
