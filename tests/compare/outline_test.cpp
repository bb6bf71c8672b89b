#include "limn/compare/outline.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <limits>
#include <set>

#include "limn/base/parallel.h"

#include "compare/pictures.h"

namespace limn {
namespace {

using test::add_triangle;
using test::disc;

// A sphere of rings and segments about the origin.
Mesh sphere(int rings, float radius) {
  Mesh mesh;
  const int segments = 2 * rings;
  for (int i = 0; i <= rings; ++i) {
    for (int j = 0; j < segments; ++j) {
      const double polar = 3.14159265358979 * i / rings, around = 6.28318530717959 * j / segments;
      mesh.positions.push_back(Vec3(radius * static_cast<float>(std::sin(polar) * std::cos(around)),
                                    radius * static_cast<float>(std::cos(polar)),
                                    radius * static_cast<float>(std::sin(polar) * std::sin(around))));
    }
  }
  for (int i = 0; i < rings; ++i) {
    for (int j = 0; j < segments; ++j) {
      const auto at = [&](int ring, int segment) {
        return static_cast<VertexId>(ring * segments + segment % segments);
      };
      mesh.faces.push_back({at(i, j), at(i, j + 1), at(i + 1, j)});
      mesh.faces.push_back({at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)});
    }
  }
  return mesh;
}

OutlineError brute_force(const Coverage& candidate, const Coverage& reference) {
  const std::vector<std::uint8_t> from = outline_pixels(candidate), to = outline_pixels(reference);
  std::vector<double> distances;
  for (int i = 0; i < static_cast<int>(from.size()); ++i) {
    if (from[i] == 0) continue;
    double nearest = std::numeric_limits<double>::max();
    for (int k = 0; k < static_cast<int>(to.size()); ++k) {
      if (to[k] != 0)
        nearest = std::min(
            nearest, std::hypot(i % candidate.width - k % candidate.width, i / candidate.width - k / candidate.width));
    }
    distances.push_back(nearest);
  }
  std::sort(distances.begin(), distances.end());
  OutlineError error;
  for (const double d : distances)
    error.mean_px += d / static_cast<double>(distances.size());
  error.max_px = distances.back();
  for (const double d : distances) {
    const auto within = std::count_if(distances.begin(), distances.end(), [&](double other) { return other <= d; });
    if (static_cast<double>(within) >= 0.95 * static_cast<double>(distances.size())) {
      error.p95_px = d;
      break;
    }
  }
  error.outline_pixels = distances.size();
  return error;
}

TEST(OutlinePixels, AreCoveredPixelsWithAnUncoveredNeighbourAmongFour) {
  Coverage coverage(5, 5);
  for (int y = 1; y < 4; ++y) {
    for (int x = 1; x < 4; ++x)
      coverage.at(x, y) = 1;
  }
  std::vector<std::uint8_t> expected = coverage.covered;
  expected[2 * 5 + 2] = 0;
  EXPECT_EQ(outline_pixels(coverage), expected);
}

TEST(OutlinePixels, TakeThePicturesRimForUncovered) {
  Coverage coverage(4, 3);
  std::fill(coverage.covered.begin(), coverage.covered.end(), std::uint8_t{1});
  const std::vector<std::uint8_t> outline = outline_pixels(coverage);
  EXPECT_EQ(std::count(outline.begin(), outline.end(), 1), 10);
}

TEST(CompareOutlines, ConcentricDiscsDifferByTheDifferenceOfTheirRadii) {
  for (const double difference : {0.0, 1.0, 3.0, 8.0, 20.0}) {
    const OutlineError grown = compare_outlines(disc(300, 150.3, 149.6, 90 + difference), disc(300, 150.3, 149.6, 90));
    EXPECT_NEAR(grown.mean_px, difference, difference == 0 ? 0 : 0.35) << difference;
    EXPECT_NEAR(grown.p95_px, difference, difference == 0 ? 0 : 0.8) << difference;
    EXPECT_NEAR(grown.max_px, difference, difference == 0 ? 0 : 1.2) << difference;
    const double ratio = 90 / (90 + difference);
    EXPECT_NEAR(grown.iou, ratio * ratio, 0.003) << difference;
    const OutlineError shrunk = compare_outlines(disc(300, 150.3, 149.6, 90 - difference), disc(300, 150.3, 149.6, 90));
    EXPECT_NEAR(shrunk.mean_px, difference, difference == 0 ? 0 : 0.35) << difference;
  }
}

TEST(CompareOutlines, EqualsBruteForceOnRandomPictures) {
  Random random(1);
  for (int picture = 0; picture < 100; ++picture) {
    Coverage pair[2];
    for (Coverage& coverage : pair) {
      coverage = disc(40, random.uniform(5, 35), random.uniform(5, 35), random.uniform(1, 14));
      for (int i = 0; i < 5; ++i)
        coverage.at(static_cast<int>(random.below(40)), static_cast<int>(random.below(40))) ^= 1;
    }
    const OutlineError actual = compare_outlines(pair[0], pair[1]);
    const OutlineError expected = brute_force(pair[0], pair[1]);
    ASSERT_NEAR(actual.mean_px, expected.mean_px, 1e-9) << picture;
    ASSERT_EQ(actual.p95_px, expected.p95_px) << picture;
    ASSERT_EQ(actual.max_px, expected.max_px) << picture;
    ASSERT_EQ(actual.outline_pixels, expected.outline_pixels) << picture;
  }
}

TEST(CompareOutlines, AMissingOutlineIsAsFarAsTheDiagonalIsLong) {
  const Coverage empty(30, 40);
  Coverage dot(30, 40);
  dot.at(4, 5) = 1;
  EXPECT_EQ(compare_outlines(empty, empty).mean_px, 0.0);
  EXPECT_EQ(compare_outlines(empty, empty).iou, 1.0);
  EXPECT_EQ(compare_outlines(empty, empty).outline_pixels, 0u);
  for (const OutlineError& error : {compare_outlines(dot, empty), compare_outlines(empty, dot)}) {
    EXPECT_EQ(error.mean_px, 50.0);
    EXPECT_EQ(error.p95_px, 50.0);
    EXPECT_EQ(error.max_px, 50.0);
    EXPECT_EQ(error.iou, 0.0);
    EXPECT_EQ(error.outline_pixels, 1u);
  }
}

TEST(CompareMeshes, AMeshHasNoErrorAgainstItself) {
  const Mesh mesh = sphere(12, 1.0f);
  const Result<Comparison> comparison = compare_meshes(mesh, mesh, {.views = 3, .size_px = 128});
  ASSERT_TRUE(comparison);
  EXPECT_EQ(comparison->overall.mean_px, 0.0);
  EXPECT_EQ(comparison->overall.max_px, 0.0);
  EXPECT_EQ(comparison->overall.iou, 1.0);
  EXPECT_GT(comparison->overall.outline_pixels, 3u * 128u);
}

TEST(CompareMeshes, ConcentricSpheresDifferByTheDifferenceOfTheirRadiiInPixels) {
  // The box's diagonal, 2·√3 radii, spans 0.9 of the picture: 512 · 0.9 / (2 √3) pixels a radius.
  const double radius_px = 512 * 0.9 / (2 * std::sqrt(3.0));
  const Result<Comparison> comparison =
      compare_meshes(sphere(100, 0.96f), sphere(100, 1.0f), {.views = 5, .size_px = 512});
  ASSERT_TRUE(comparison);
  EXPECT_NEAR(comparison->overall.mean_px, 0.04 * radius_px, 0.2);
  EXPECT_NEAR(comparison->overall.iou, 0.96 * 0.96, 0.003);
  for (const OutlineError& view : comparison->views)
    EXPECT_NEAR(view.mean_px, 0.04 * radius_px, 0.3);
}

TEST(CompareMeshes, OverallFiguresPoolTheDistancesOfAllViews) {
  const Result<Comparison> comparison =
      compare_meshes(sphere(3, 1.0f), sphere(40, 1.0f), {.views = 7, .size_px = 200, .perspective = true});
  ASSERT_TRUE(comparison);
  ASSERT_EQ(comparison->views.size(), 7u);
  double sum = 0, largest = 0, iou = 0;
  std::size_t pixels = 0;
  for (const OutlineError& view : comparison->views) {
    sum += view.mean_px * static_cast<double>(view.outline_pixels);
    pixels += view.outline_pixels;
    largest = std::max(largest, view.max_px);
    iou += view.iou / 7;
  }
  EXPECT_GT(comparison->overall.mean_px, 0.5);
  EXPECT_EQ(comparison->overall.outline_pixels, pixels);
  EXPECT_NEAR(comparison->overall.mean_px, sum / static_cast<double>(pixels), 1e-9);
  EXPECT_EQ(comparison->overall.max_px, largest);
  EXPECT_NEAR(comparison->overall.iou, iou, 1e-12);
}

TEST(CompareMeshes, LooksFromAllSidesAndFromOthersWithAnotherSeed) {
  const Mesh mesh = sphere(4, 1.0f);
  const CompareOptions options{.views = 64, .size_px = 16};
  const Result<Comparison> first = compare_meshes(mesh, mesh, options);
  ASSERT_TRUE(first);
  std::set<int> octants;
  for (const Vec3& d : first->directions)
    octants.insert((d.x > 0 ? 1 : 0) + (d.y > 0 ? 2 : 0) + (d.z > 0 ? 4 : 0));
  EXPECT_EQ(octants.size(), 8u);
  const Result<Comparison> again = compare_meshes(mesh, mesh, options);
  EXPECT_EQ(first->directions, again->directions);
  const Result<Comparison> other = compare_meshes(mesh, mesh, {.views = 64, .size_px = 16, .seed = 2});
  EXPECT_NE(first->directions, other->directions);
}

TEST(CompareMeshes, AsksForTheCandidateOnceAViewWithTheViewsOwnCamera) {
  const Mesh mesh = sphere(6, 1.0f);
  std::vector<Vec3> eyes;
  const MeshForCamera candidate = [&](const Camera& camera, int height_px) -> Result<Mesh> {
    EXPECT_EQ(height_px, 64);
    EXPECT_TRUE(camera.orthographic);
    eyes.push_back(camera.eye - camera.target);
    return mesh;
  };
  const Result<Comparison> comparison = compare_meshes(candidate, mesh, {.views = 4, .size_px = 64});
  ASSERT_TRUE(comparison);
  ASSERT_EQ(eyes.size(), 4u);
  for (int i = 0; i < 4; ++i) {
    const float length = std::sqrt(eyes[i].x * eyes[i].x + eyes[i].y * eyes[i].y + eyes[i].z * eyes[i].z);
    EXPECT_NEAR(eyes[i].x / length, comparison->directions[i].x, 1e-5);
    EXPECT_NEAR(eyes[i].y / length, comparison->directions[i].y, 1e-5);
    EXPECT_NEAR(eyes[i].z / length, comparison->directions[i].z, 1e-5);
  }
}

TEST(CompareMeshes, GivesTheSameFiguresForAnyNumberOfThreads) {
  const Mesh coarse = sphere(5, 1.0f), fine = sphere(80, 1.0f);
  const auto with_threads = [&](int threads) {
    const ThreadLimit limit(threads);
    return compare_meshes(coarse, fine, {.views = 3, .size_px = 200});
  };
  const Result<Comparison> expected = with_threads(1);
  ASSERT_TRUE(expected);
  for (const int threads : {2, 5}) {
    const Result<Comparison> actual = with_threads(threads);
    ASSERT_TRUE(actual);
    EXPECT_EQ(actual->overall.mean_px, expected->overall.mean_px);
    EXPECT_EQ(actual->overall.iou, expected->overall.iou);
  }
}

TEST(CompareMeshes, ACandidateWithoutFacesIsAsFarAsTheDiagonalIsLong) {
  const Result<Comparison> comparison = compare_meshes(Mesh(), sphere(6, 1.0f), {.views = 2, .size_px = 100});
  ASSERT_TRUE(comparison);
  EXPECT_NEAR(comparison->overall.mean_px, 100 * std::sqrt(2.0), 1e-9);
  EXPECT_EQ(comparison->overall.iou, 0.0);
}

TEST(CompareMeshes, RefusesWhatItCannotMeasure) {
  const Mesh mesh = sphere(4, 1.0f);
  const auto code = [&](const CompareOptions& options) { return compare_meshes(mesh, mesh, options).error().code; };
  EXPECT_EQ(compare_meshes(mesh, Mesh()).error().code, ErrorCode::kUnsuitable);
  EXPECT_EQ(code({.views = 0}), ErrorCode::kInvalidArgument);
  EXPECT_EQ(code({.size_px = 0}), ErrorCode::kInvalidArgument);
  EXPECT_EQ(code({.size_px = kMaxCoverageSize + 1}), ErrorCode::kInvalidArgument);
  EXPECT_EQ(code({.fill = 0.0f}), ErrorCode::kInvalidArgument);
  EXPECT_EQ(code({.fill = std::numeric_limits<float>::quiet_NaN()}), ErrorCode::kInvalidArgument);
  const auto stop = [](std::string_view, double) { return false; };
  EXPECT_EQ(code({.views = 1, .size_px = 16, .progress = stop}), ErrorCode::kCancelled);
  const MeshForCamera failing = [](const Camera&, int) -> Result<Mesh> { return fail(ErrorCode::kUnsuitable, "no"); };
  EXPECT_EQ(compare_meshes(failing, mesh, {.views = 1, .size_px = 16}).error().message, "no");
}

TEST(CompareMeshes, RefusesWhatNoCameraCanStandOutsideOf) {
  Mesh mesh;
  mesh.positions = {{-3e38f, 0, 0}, {3e38f, 0, 0}, {0, 3e38f, 0}};
  mesh.faces = {{0, 1, 2}};
  const auto comparison = compare_meshes(mesh, mesh, {.views = 2, .size_px = 64});
  ASSERT_FALSE(comparison);
  EXPECT_EQ(comparison.error().code, ErrorCode::kUnsuitable);
}

}  // namespace
}  // namespace limn
