#include "limn/silhouette/search/moving_silhouette.h"

#include <algorithm>
#include <gtest/gtest.h>

#include "limn/mesh/shapes.h"
#include "limn/silhouette/brute.h"
#include "limn/silhouette/search/edge_clusters.h"

#include "silhouette/eyes.h"
#include "support/stable.h"

namespace limn::test {
namespace {

constexpr float kHalfDegree = 0.00872665f;

/// What moving silhouettes of one mesh need.
struct Searched {
  explicit Searched(Mesh searched)
      : mesh(std::move(searched)),
        topology(build_topology(mesh)),
        planes(face_planes(mesh)),
        tree(leaf_clusters(mesh, topology, planes), planes, quantized_frame(mesh, planes)) {}
  Searched(const Searched&) = delete;
  Searched& operator=(const Searched&) = delete;

  Mesh mesh;
  Topology topology;
  std::vector<Plane> planes;
  SearchTree tree;
};

/// What queries along a path did.
struct Walk {
  std::size_t wrong = 0;  ///< steps at which a level's set was not the oracle's, or its order not the scalar one's
  std::size_t gathered = 0;
  std::size_t searched = 0;
  std::size_t tested = 0;
};

Walk walk(const Searched& searched, std::span<const Eye> path) {
  Walk result;
  std::vector<MovingSilhouette> moving(simd_levels().size(), MovingSilhouette(searched.tree));
  std::vector<EdgeId> oracle, scalar, sorted;
  for (const Eye& eye : path) {
    extract_silhouette_brute(searched.topology, searched.planes, eye, oracle);
    for (std::size_t i = 0; i < moving.size(); ++i) {
      const auto found = moving[i].find(eye, simd_levels()[i]);
      if (i == 0) scalar.assign(found.begin(), found.end());
      sorted.assign(found.begin(), found.end());
      std::sort(sorted.begin(), sorted.end());
      result.wrong +=
          sorted == oracle && std::equal(found.begin(), found.end(), scalar.begin(), scalar.end()) ? 0u : 1u;
    }
    result.gathered += moving[0].counters().gathered ? 1u : 0u;
    result.searched += moving[0].counters().searched ? 1u : 0u;
    result.tested += moving[0].counters().leaves_tested;
  }
  return result;
}

std::vector<Eye> orbit(int frames, float step_rad, float radius) {
  std::vector<Eye> path;
  for (int i = 0; i < frames; ++i) {
    const float angle = step_rad * static_cast<float>(i);
    path.push_back({Vec3(radius * std::cos(angle), 0.2f * radius, radius * std::sin(angle))});
  }
  return path;
}

TEST(MovingSilhouette, EqualsTheOracleAlongAnOrbit) {
  for (const Shape shape : {Shape::kAsteroid, Shape::kKnot, Shape::kSheet, Shape::kTerrain}) {
    const Searched searched(*make_shape(shape, {.faces = 20'000}));
    EXPECT_EQ(walk(searched, orbit(200, kHalfDegree, 3.0f)).wrong, 0u);
    EXPECT_EQ(walk(searched, orbit(60, -10.0f * kHalfDegree, 2.0f)).wrong, 0u);
  }
}

TEST(MovingSilhouette, LooksAtFewLeavesAlongAnOrbit) {
  const Searched searched(*make_shape(Shape::kKnot, {.faces = 100'000}));
  const Walk result = walk(searched, orbit(200, kHalfDegree, 3.0f));
  EXPECT_LE(result.searched, 1u);
  EXPECT_LT(result.gathered * (MovingSilhouette::kSteps - 2), 200u);
  std::size_t entered = 0;
  SearchScratch scratch;
  for (const Eye& eye : orbit(200, kHalfDegree, 3.0f)) {
    SearchCounters counters;
    searched.tree.find(eye, scratch, &counters);
    entered += counters.leaves_tested;
  }
  EXPECT_LT(result.tested, entered);
}

TEST(MovingSilhouette, EqualsTheOracleAlongWalksOfEverySmoothness) {
  for (const Shape shape : {Shape::kKnot, Shape::kHoles3}) {
    const Searched searched(*make_shape(shape, {.faces = 6000}));
    for (const float unsteadiness : {0.0f, 0.01f, 0.1f, 0.5f, 3.0f}) {
      Random random(7);
      std::vector<Eye> path{{Vec3(2.5f, 0.3f, 0.1f)}};
      Vec3 direction = random.direction();
      for (int i = 0; i < 400; ++i) {
        direction = glm::normalize(direction + unsteadiness * random.direction());
        if (i % 97 == 0) direction = -direction;
        if (glm::length(path.back().at) > 4.0f) direction = -glm::normalize(path.back().at);
        path.push_back({path.back().at + (0.001f + 0.03f * static_cast<float>(random.uniform())) * direction});
      }
      EXPECT_EQ(walk(searched, path).wrong, 0u) << unsteadiness;
    }
  }
}

TEST(MovingSilhouette, EqualsTheOracleThroughTheMeshAndOutAgain) {
  // Straight and in exact steps, so that faces turn exactly at the ends of slices.
  for (const Shape shape : {Shape::kCube, Shape::kAsteroid, Shape::kKnot}) {
    const Searched searched(*make_shape(shape, {.faces = 3000}));
    std::vector<Eye> path;
    for (int i = 0; i < 256; ++i)
      path.push_back({Vec3(2.0f - 0x1.0p-6f * static_cast<float>(i), 0.25f, 0.0f)});
    for (int i = 0; i < 64; ++i)
      path.push_back({Vec3(2.0f - 0x1.0p-4f * static_cast<float>(i), 0.25f, 0.0f), true});
    EXPECT_EQ(walk(searched, path).wrong, 0u);
  }
}

TEST(MovingSilhouette, EqualsTheOracleThroughJumpsStopsAndChangesOfProjection) {
  for (const StableMesh& stable : awkward_meshes()) {
    const Searched searched(stable.mesh);
    std::vector<Eye> path;
    Random random(3);
    for (const Eye& eye : awkward_eyes(stable.mesh, 40, 31)) {
      path.push_back(eye);
      path.push_back(eye);
      const Vec3 step = 0.02f * glm::length(eye.at) * random.direction();
      for (int i = 0; i < 6; ++i)
        path.push_back({path.back().at + (i == 3 ? Vec3(0.0f) : step), eye.orthographic});
      path.push_back({path.back().at, !eye.orthographic});
    }
    EXPECT_EQ(walk(searched, path).wrong, 0u) << stable.name;
  }
}

TEST(MovingSilhouette, JumpsAskTheTree) {
  const Searched searched(*make_shape(Shape::kKnot, {.faces = 5000}));
  std::vector<Eye> path;
  Random random(9);
  for (int i = 0; i < 30; ++i)
    path.push_back({3.0f * random.direction()});
  const Walk result = walk(searched, path);
  EXPECT_EQ(result.wrong, 0u);
  EXPECT_EQ(result.searched, path.size());
}

}  // namespace
}  // namespace limn::test
