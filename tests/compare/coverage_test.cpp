#include "limn/compare/coverage.h"

#include <algorithm>
#include <array>
#include <gtest/gtest.h>
#include <limits>
#include <vector>

#include "limn/base/parallel.h"

#include "compare/pictures.h"

namespace limn {
namespace {

using test::add_triangle;
using test::at_pixel;
using test::pixel_camera;

// The rule in words: a centre on the triangle's inner side of all three edges, or on an edge whose inside lies below or
// to the right of it. Coordinates in grid steps of 1/256 pixel, y downwards.
struct Steps {
  long long x, y;
};

bool covers(std::array<Steps, 3> t, Steps p) {
  const auto side = [](Steps a, Steps b, Steps q) { return (b.x - a.x) * (q.y - a.y) - (b.y - a.y) * (q.x - a.x); };
  const long long area = side(t[0], t[1], t[2]);
  if (area == 0) return false;
  for (int i = 0; i < 3; ++i) {
    const Steps a = t[i], b = t[(i + 1) % 3], c = t[(i + 2) % 3];
    const long long s = area > 0 ? side(a, b, p) : -side(a, b, p);
    if (s < 0) return false;
    const bool interior_below = a.y == b.y && c.y > a.y;
    const bool interior_right = a.y != b.y && (side(a, b, {p.x + 1000000, p.y}) > 0) == (area > 0);
    if (s == 0 && !interior_below && !interior_right) return false;
  }
  return true;
}

Coverage covered_by_definition(const std::vector<std::array<Steps, 3>>& triangles, int width, int height) {
  Coverage coverage(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Steps center{x * 256 + 128, y * 256 + 128};
      for (const auto& t : triangles) {
        if (covers(t, center)) coverage.at(x, y) = 1;
      }
    }
  }
  return coverage;
}

Mesh mesh_of(const std::vector<std::array<Steps, 3>>& triangles) {
  Mesh mesh;
  const auto vertex = [](Steps s) { return at_pixel(static_cast<double>(s.x) / 256, static_cast<double>(s.y) / 256); };
  for (const auto& t : triangles)
    add_triangle(mesh, vertex(t[0]), vertex(t[1]), vertex(t[2]));
  return mesh;
}

std::size_t count(const Coverage& coverage) {
  return static_cast<std::size_t>(std::count(coverage.covered.begin(), coverage.covered.end(), 1));
}

TEST(RasterizeCoverage, EqualsTheRuleTestedPixelByPixelOnRandomPictures) {
  Random random(7);
  for (int picture = 0; picture < 3000; ++picture) {
    const int width = 1 + static_cast<int>(random.below(40));
    const int height = 1 + static_cast<int>(random.below(20));
    // Coarse steps put many centres exactly on edges and corners; wide ranges leave the picture on all sides.
    const long long step = picture % 3 == 0 ? 128 : picture % 3 == 1 ? 64 : 1;
    const long long reach = picture % 2 == 0 ? 10 * 256 : 50 * 256;
    const auto coordinate = [&](int size) {
      const long long low = size * 128 - reach;
      return (low + static_cast<long long>(random.below(2 * reach))) / step * step;
    };
    std::vector<std::array<Steps, 3>> triangles(1 + random.below(3));
    for (auto& t : triangles) {
      for (Steps& corner : t)
        corner = {coordinate(width), coordinate(height)};
    }
    const Coverage actual = rasterize_coverage(mesh_of(triangles), pixel_camera(width, height), width, height);
    ASSERT_EQ(actual.covered, covered_by_definition(triangles, width, height).covered) << "picture " << picture;
  }
}

TEST(RasterizeCoverage, WideTrianglesEqualTheRuleToo) {
  Random random(8);
  for (int picture = 0; picture < 60; ++picture) {
    const int width = 150, height = 90;
    const long long step = picture % 2 == 0 ? 128 : 1;
    std::array<Steps, 3> t;
    for (Steps& corner : t) {
      corner = {static_cast<long long>(random.below(250 * 256)) / step * step - 50 * 256,
                static_cast<long long>(random.below(150 * 256)) / step * step - 30 * 256};
    }
    const Coverage actual = rasterize_coverage(mesh_of({t}), pixel_camera(width, height), width, height);
    ASSERT_EQ(actual.covered, covered_by_definition({t}, width, height).covered) << "picture " << picture;
  }
}

TEST(RasterizeCoverage, BothWindingsCoverTheSamePixels) {
  const std::array<Steps, 3> t{Steps{128, 128}, Steps{2000, 700}, Steps{640, 2432}};
  const Camera camera = pixel_camera(12, 12);
  const Coverage front = rasterize_coverage(mesh_of({t}), camera, 12, 12);
  const Coverage back = rasterize_coverage(mesh_of({{t[0], t[2], t[1]}}), camera, 12, 12);
  EXPECT_GT(count(front), 10u);
  EXPECT_EQ(front.covered, back.covered);
}

TEST(RasterizeCoverage, AFanAroundAnInnerPointLosesNoPixelAtItsEdges) {
  Random random(3);
  for (int picture = 0; picture < 200; ++picture) {
    // The fan's rim is the picture's, so every pixel must be covered; half of the inner points lie on pixel centres.
    const int size = 24;
    const double round = picture % 2 == 0 ? 2.0 : 65536.0;
    const auto inner = [&] { return std::floor(random.uniform(1, size - 1) * round) / round; };
    const Vec3 middle = at_pixel(inner(), inner());
    std::vector<Vec3> rim;
    for (int side = 0; side < 4; ++side) {
      for (int i = 0; i < 5; ++i) {
        const double t = size * i / 5.0;
        rim.push_back(side == 0   ? at_pixel(t, 0)
                      : side == 1 ? at_pixel(size, t)
                      : side == 2 ? at_pixel(size - t, size)
                                  : at_pixel(0, size - t));
      }
    }
    Mesh mesh;
    for (std::size_t i = 0; i < rim.size(); ++i)
      add_triangle(mesh, middle, rim[i], rim[(i + 1) % rim.size()]);
    const Coverage coverage = rasterize_coverage(mesh, pixel_camera(size, size), size, size);
    ASSERT_EQ(count(coverage), static_cast<std::size_t>(size * size)) << "picture " << picture;
  }
}

TEST(RasterizeCoverage, NoPixelIsCoveredByTwoFacesOfAFan) {
  // Disjoint halves of a quad: their coverages are disjoint as well, so an edge belongs to exactly one side.
  Random random(4);
  for (int picture = 0; picture < 300; ++picture) {
    const int size = 16;
    const auto half = [&](double low, double high) { return std::floor(random.uniform(low, high) * 2) / 2; };
    const Vec3 a = at_pixel(half(0, 5), half(0, 16)), b = at_pixel(half(11, 16), half(0, 16));
    const Vec3 above = at_pixel(half(6, 10), -3), below = at_pixel(half(6, 10), 19);
    Mesh upper, lower;
    add_triangle(upper, a, b, above);
    add_triangle(lower, b, a, below);
    const Camera camera = pixel_camera(size, size);
    const Coverage up = rasterize_coverage(upper, camera, size, size);
    const Coverage down = rasterize_coverage(lower, camera, size, size);
    for (std::size_t i = 0; i < up.covered.size(); ++i)
      ASSERT_FALSE(up.covered[i] && down.covered[i]) << picture;
  }
}

TEST(RasterizeCoverage, FacesWithoutAreaAndWithoutFiniteCoordinatesCoverNothing) {
  Mesh mesh;
  add_triangle(mesh, at_pixel(1, 1), at_pixel(9, 9), at_pixel(5, 5));
  add_triangle(mesh, at_pixel(2.5, 2.5), at_pixel(2.5, 2.5), at_pixel(2.5, 2.5));
  add_triangle(mesh, at_pixel(2, 2), at_pixel(8, 2), at_pixel(std::numeric_limits<double>::quiet_NaN(), 8));
  add_triangle(mesh, at_pixel(2, 2), at_pixel(8, 2), at_pixel(5, std::numeric_limits<double>::infinity()));
  EXPECT_EQ(count(rasterize_coverage(mesh, pixel_camera(10, 10), 10, 10)), 0u);
  EXPECT_EQ(count(rasterize_coverage(Mesh(), pixel_camera(10, 10), 10, 10)), 0u);
}

TEST(RasterizeCoverage, HugeTrianglesAreCutAtTheGuardBandWithoutMovingTheirEdges) {
  // Half planes: an edge through the picture at 45 degrees whose ends are up to 1e12 pixels away.
  const int size = 32;
  for (const double far : {1e3, 1e6, 2e6, 1e8, 1e12}) {
    Mesh mesh;
    add_triangle(mesh, at_pixel(-far, -far), at_pixel(far, far), at_pixel(-far, far));
    const Coverage coverage = rasterize_coverage(mesh, pixel_camera(size, size), size, size);
    for (int y = 0; y < size; ++y) {
      for (int x = 0; x < size; ++x) {
        if (x == y) continue;
        ASSERT_EQ(coverage.at(x, y), x < y ? 1 : 0) << far << " at " << x << ", " << y;
      }
    }
  }
}

TEST(RasterizeCoverage, AnyFiniteCoordinatesAreSafeInBothProjections) {
  Random random(13);
  Mesh mesh;
  const auto coordinate = [&] {
    const double magnitude = std::pow(10.0, random.uniform(-40, 38));
    return static_cast<float>(random.below(2) == 0 ? magnitude : -magnitude);
  };
  const auto vertex = [&] { return Vec3(coordinate(), coordinate(), coordinate()); };
  for (int i = 0; i < 2000; ++i)
    add_triangle(mesh, vertex(), vertex(), vertex());
  Camera camera;
  camera.eye = Vec3(0);
  camera.target = Vec3(1, 2, -1);
  for (const bool orthographic : {true, false}) {
    camera.orthographic = orthographic;
    const Coverage coverage = rasterize_coverage(mesh, camera, 32, 24);
    EXPECT_GT(count(coverage), 32u * 24u / 2) << "hundreds of half planes cover most of the picture";
  }
}

TEST(RasterizeCoverage, HugeNeighboursShareTheirCutEdge) {
  Random random(5);
  const int size = 32;
  for (int picture = 0; picture < 300; ++picture) {
    const double far = std::pow(10.0, random.uniform(4, 9));
    const Vec3 middle = at_pixel(random.uniform(0, size), random.uniform(0, size));
    const Vec3 corners[] = {at_pixel(-far, -far * random.uniform(0.5, 2)), at_pixel(far * random.uniform(0.5, 2), -far),
                            at_pixel(far, far * random.uniform(0.5, 2)), at_pixel(-far * random.uniform(0.5, 2), far)};
    Mesh mesh;
    for (int i = 0; i < 4; ++i)
      add_triangle(mesh, middle, corners[i], corners[(i + 1) % 4]);
    const Coverage coverage = rasterize_coverage(mesh, pixel_camera(size, size), size, size);
    ASSERT_EQ(count(coverage), static_cast<std::size_t>(size * size)) << "picture " << picture;
  }
}

TEST(RasterizeCoverage, ProjectsWhereTheMatricesOfTheCameraDo) {
  Random random(6);
  for (int i = 0; i < 400; ++i) {
    Camera camera;
    camera.target = random.direction();
    camera.eye = camera.target + random.direction() * 5.0f;
    camera.up = i % 4 == 0 ? camera.eye - camera.target : random.direction();
    camera.orthographic = i % 2 == 0;
    const int width = 60, height = 40;
    const Vec3 at = camera.target + random.direction() * 0.5f;
    const Vec4 clip = projection_matrix(camera, 1.5f) * view_matrix(camera) * Vec4(at, 1);
    const double x = (clip.x / clip.w * 0.5 + 0.5) * width;
    const double y = (0.5 - clip.y / clip.w * 0.5) * height;
    // A speck around the point covers the pixel it projects to.
    Mesh mesh;
    const float r = 0.12f;
    const Vec3 corners[] = {at + Vec3(r, r, r), at + Vec3(-r, -r, r), at + Vec3(-r, r, -r), at + Vec3(r, -r, -r)};
    for (int k = 0; k < 4; ++k)
      add_triangle(mesh, corners[k], corners[(k + 1) % 4], corners[(k + 2) % 4]);
    const Coverage coverage = rasterize_coverage(mesh, camera, width, height);
    double sum_x = 0, sum_y = 0;
    for (int py = 0; py < height; ++py) {
      for (int px = 0; px < width; ++px) {
        sum_x += coverage.at(px, py) * (px + 0.5);
        sum_y += coverage.at(px, py) * (py + 0.5);
      }
    }
    ASSERT_GT(count(coverage), 3u);
    EXPECT_NEAR(sum_x / static_cast<double>(count(coverage)), x, 1.0);
    EXPECT_NEAR(sum_y / static_cast<double>(count(coverage)), y, 1.0);
  }
}

// Cuts a triangle at the near plane z = -near by plain formulas, for a camera at the origin that looks along -z.
void add_cut_triangle(Mesh& mesh, const std::array<Vec3, 3>& t, float near) {
  std::vector<Vec3> kept;
  for (int i = 0; i < 3; ++i) {
    const DVec3 a(t[i]), b(t[(i + 1) % 3]);
    if (a.z <= -near) kept.push_back(t[i]);
    if ((a.z <= -near) != (b.z <= -near)) {
      const double share = (-near - a.z) / (b.z - a.z);
      kept.push_back(
          Vec3(static_cast<float>(a.x + share * (b.x - a.x)), static_cast<float>(a.y + share * (b.y - a.y)), -near));
    }
  }
  for (std::size_t i = 2; i < kept.size(); ++i)
    add_triangle(mesh, kept[0], kept[i - 1], kept[i]);
}

TEST(RasterizeCoverage, TrianglesThroughTheNearPlaneEqualTrianglesCutThereBeforehand) {
  Random random(9);
  Camera camera;
  camera.eye = Vec3(0);
  camera.target = Vec3(0, 0, -1);
  camera.near_distance = 0.5f;
  camera.fov_rad = 1.2f;
  const int size = 48;
  std::size_t different = 0, covered = 0;
  for (int picture = 0; picture < 400; ++picture) {
    std::array<Vec3, 3> t;
    for (Vec3& p : t)
      p = Vec3(random.direction() * 2.0f) + Vec3(0, 0, -0.8f);
    Mesh whole, cut;
    add_triangle(whole, t[0], t[1], t[2]);
    add_cut_triangle(cut, t, camera.near_distance);
    const Coverage actual = rasterize_coverage(whole, camera, size, size);
    const Coverage expected = rasterize_coverage(cut, camera, size, size);
    for (std::size_t i = 0; i < actual.covered.size(); ++i)
      different += actual.covered[i] != expected.covered[i];
    covered += count(expected);
  }
  // The oracle's corners are rounded to float, so a few centres near an edge may fall to the other side.
  EXPECT_GT(covered, 20000u);
  EXPECT_LE(different, covered / 5000);
}

TEST(RasterizeCoverage, NeighboursThroughTheNearPlaneLoseNoPixelBetweenThem) {
  Random random(10);
  Camera camera;
  camera.eye = Vec3(0);
  camera.target = Vec3(0, 0, -1);
  camera.near_distance = 0.01f;
  const int size = 64;
  for (int picture = 0; picture < 200; ++picture) {
    // A floor that fills the lower half of the picture, from behind the eye to the horizon, as a fan about a random
    // point.
    const auto on_floor = [&](double x, double z) { return Vec3(static_cast<float>(x), -1.0f, static_cast<float>(z)); };
    const Vec3 middle = on_floor(random.uniform(-3, 3), random.uniform(-8, 1));
    const Vec3 rim[] = {on_floor(-1e6, 1e3), on_floor(1e6, 1e3), on_floor(1e6, -1e7), on_floor(-1e6, -1e7)};
    Mesh mesh;
    for (int i = 0; i < 4; ++i)
      add_triangle(mesh, middle, rim[i], rim[(i + 1) % 4]);
    const Coverage coverage = rasterize_coverage(mesh, camera, size, size);
    for (int y = 0; y < size; ++y) {
      for (int x = 0; x < size; ++x)
        ASSERT_EQ(coverage.at(x, y), y >= size / 2 ? 1 : 0) << picture << ": " << x << ", " << y;
    }
  }
}

TEST(RasterizeCoverage, AMeshBehindTheEyeCoversNothing) {
  Camera camera;
  camera.eye = Vec3(0);
  camera.target = Vec3(0, 0, -1);
  Mesh mesh;
  add_triangle(mesh, Vec3(-5, -5, 3), Vec3(5, -5, 3), Vec3(0, 5, 3));
  EXPECT_EQ(count(rasterize_coverage(mesh, camera, 16, 16)), 0u);
}

TEST(RasterizeCoverage, TinyAndHugeModelsGiveThePictureOfOneOfSizeOne) {
  Random random(11);
  Mesh mesh;
  for (int i = 0; i < 40; ++i)
    add_triangle(mesh, random.direction(), random.direction(), random.direction());
  const Vec3 direction = random.direction();
  const auto picture = [&](float scale, bool orthographic) {
    Mesh scaled = mesh;
    for (Vec3& p : scaled.positions)
      p *= scale;
    const Camera camera = fit_camera(bounds_of(scaled.positions), direction, {.orthographic = orthographic});
    return rasterize_coverage(scaled, camera, 64, 64).covered;
  };
  for (const bool orthographic : {true, false}) {
    const auto expected = picture(1.0f, orthographic);
    // Powers of two, so that the vertices are the same but for the exponent.
    for (const float scale : {0x1p-100f, 0x1p-30f, 0x1p30f, 0x1p100f})
      EXPECT_EQ(picture(scale, orthographic), expected) << scale;
  }
}

TEST(RasterizeCoverage, IsTheSameForAnyNumberOfThreads) {
  Random random(12);
  Mesh mesh;
  for (int i = 0; i < 30000; ++i) {
    const Vec3 at = random.direction();
    add_triangle(mesh, at, at + random.direction() * 0.05f, at + random.direction() * 0.05f);
  }
  const Camera camera = fit_camera(bounds_of(mesh.positions), 0.3f, 0.2f);
  const auto with_threads = [&](int threads) {
    const ThreadLimit limit(threads);
    return rasterize_coverage(mesh, camera, 500, 300).covered;
  };
  const auto expected = with_threads(1);
  for (const int threads : {2, 3, 7})
    EXPECT_EQ(with_threads(threads), expected) << threads;
}

}  // namespace
}  // namespace limn
