#include "limn/refine/levels.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "limn/base/random.h"
#include "limn/mesh/normals.h"
#include "limn/mesh/shapes.h"
#include "limn/refine/refine.h"

namespace limn {
namespace {

struct Levelled {
  Mesh mesh;
  Topology topology;
  std::vector<Vec3> normals;
  std::vector<EdgeCurve> curves;

  explicit Levelled(Mesh given) : mesh(std::move(given)) {
    topology = build_topology(mesh);
    normals = face_normals(mesh);
    if (mesh.normals.empty()) mesh.normals = crease_normals(mesh, topology, 1.0f);
    curves = edge_curves(mesh, topology);
  }
  Result<std::vector<float>> levels(const View& view, const LevelOptions& options) const {
    return edge_levels(mesh, topology, normals, curves, view, options);
  }
};

Mesh shape(Shape kind, std::size_t faces) {
  return make_shape(kind, {.faces = faces}).value();
}

TEST(EdgeLevels, AreTheMaximalLevelTimesTheSilhouetteness) {
  const Levelled torus(shape(Shape::kTorus, 2000));
  const View view{{Vec3(1, 2, 3), false}, 0};
  const std::vector<float> levels = torus.levels(view, {.max_level = 4}).value();
  const std::vector<float> alpha = edge_silhouetteness(torus.mesh, torus.topology, torus.normals, view.eye);
  std::size_t between = 0;
  for (std::size_t e = 0; e < levels.size(); ++e) {
    EXPECT_EQ(levels[e], quantized_level(4.0 * double{alpha[e]}));
    between += levels[e] > 0 && levels[e] < 4;
  }
  EXPECT_GT(between, 20u);
}

TEST(EdgeLevels, AreMultiplesOfTheirUnitWhateverTheCriterion) {
  const Levelled knot(shape(Shape::kKnot, 3000));
  const View view{{Vec3(1, 2, 6), false}, 800};
  std::size_t between = 0;
  for (const float pixels : {0.0f, 0.5f}) {
    for (const Criterion criterion : {Criterion::kSilhouette, Criterion::kDistance, Criterion::kCurvature}) {
      const LevelOptions options{.criterion = criterion, .max_level = 3, .pixels = pixels};
      const std::vector<float> levels = knot.levels(view, options).value();
      for (const float level : levels) {
        const float units = level / kLevelUnit;
        EXPECT_EQ(units, std::floor(units));
        between += level > 0.0f && level != std::floor(level);
      }
    }
  }
  EXPECT_GT(between, 1000u);
}

TEST(QuantizedLevel, IsTheNearestMultipleAndTheUpperOfTwo) {
  Random random(12);
  for (int n = 0; n < 10000; ++n) {
    const double level = random.uniform(0.0, kMaxLevel);
    EXPECT_LE(std::abs(double{quantized_level(level)} - level), 0.5 * double{kLevelUnit});
  }
  EXPECT_EQ(quantized_level(0.0), 0.0f);
  EXPECT_EQ(quantized_level(kMaxLevel), 8.0f);
  EXPECT_EQ(quantized_level(2.5 * double{kLevelUnit}), 3.0f * kLevelUnit);
  EXPECT_EQ(quantized_level(0.49 * double{kLevelUnit}), 0.0f);
}

TEST(EdgeLevels, ByPixelsBringTheCurveWithinTheToleranceAtUniformCriterion) {
  const Levelled sphere(shape(Shape::kIcosphere, 320));
  constexpr float kTau = 0.25f;
  for (const bool orthographic : {false, true}) {
    const Eye eye{Vec3(0.3f, 0.4f, 5), orthographic};
    const View view{eye, orthographic ? 400.0f : 2000.0f};
    const auto levels = sphere.levels(view, {.criterion = Criterion::kUniform, .max_level = 8, .pixels = kTau}).value();
    for (std::size_t e = 0; e < levels.size(); ++e) {
      // The polyline of 2^level segments against the cubic, by dense sampling, as seen from the eye.
      const Edge& edge = sphere.topology.edges[e];
      const Vec3 p = sphere.mesh.positions[edge.v[0]];
      const Vec3 q = sphere.mesh.positions[edge.v[1]];
      const int m = static_cast<int>(std::ceil(levels[e]));
      const Vec3 middle = (p + q) * 0.5f;
      const Vec3 to_eye = orthographic ? eye.at : eye.at - middle;
      const Vec3 sight = glm::normalize(to_eye);
      const float scale = view.pixels_per_unit / (orthographic ? 1.0f : glm::length(to_eye));
      double worst = 0;
      for (int k = 0; k < 1 << m; ++k) {
        const Vec3 a = evaluate_curve(p, sphere.curves[e], q, k, m);
        const Vec3 b = evaluate_curve(p, sphere.curves[e], q, k + 1, m);
        const Vec3 c = m < 8 ? evaluate_curve(p, sphere.curves[e], q, 2 * k + 1, m + 1) : (a + b) * 0.5f;
        const Vec3 stray = c - (a + b) * 0.5f;
        worst = std::max(worst, double{glm::length(stray - sight * glm::dot(stray, sight)) * scale});
      }
      EXPECT_LT(worst, 1.05 * kTau);
    }
  }
}

TEST(EdgeLevels, ByDistanceFallWithTheLogarithmOfIt) {
  Mesh strip;
  for (int i = 0; i <= 20; ++i) {
    strip.positions.emplace_back(static_cast<float>(i), -0.01f, 0);
    strip.positions.emplace_back(static_cast<float>(i), 0.01f, 0);
  }
  for (VertexId i = 0; i < 40; i += 2) {
    strip.faces.push_back({i, i + 2, i + 3});
    strip.faces.push_back({i, i + 3, i + 1});
  }
  const Levelled strip_levels(strip);
  const View view{{Vec3(0), false}, 0};
  const LevelOptions options{.criterion = Criterion::kDistance, .max_level = 4, .near_distance = 1, .far_distance = 16};
  const std::vector<float> levels = strip_levels.levels(view, options).value();
  for (std::size_t e = 0; e < levels.size(); ++e) {
    const Edge& edge = strip_levels.topology.edges[e];
    const float distance = glm::length((strip.positions[edge.v[0]] + strip.positions[edge.v[1]]) * 0.5f);
    const double expected = distance <= 1 ? 4 : distance >= 16 ? 0 : 4 - std::log2(double{distance});
    EXPECT_NEAR(levels[e], expected, 1e-5 + 0.5 * double{kLevelUnit});
  }
}

TEST(EdgeLevels, ByCurvatureRefineASphereButNoPlane) {
  const Levelled sphere(shape(Shape::kIcosphere, 320));
  const std::vector<float> curvature = gaussian_curvature(sphere.mesh, sphere.topology);
  for (VertexId v = 0; v < curvature.size(); ++v) {
    if (sphere.topology.weld[v] == v) {
      EXPECT_NEAR(curvature[v], 1.0f, 0.12f);
    }
  }
  const LevelOptions options{.criterion = Criterion::kCurvature};
  const std::vector<float> on_sphere = sphere.levels({}, options).value();
  EXPECT_GT(*std::min_element(on_sphere.begin(), on_sphere.end()), 0.5f);
  const Levelled cube(shape(Shape::kCube, 300));
  const std::vector<float> on_cube = cube.levels({}, options).value();
  EXPECT_LT(*std::min_element(on_cube.begin(), on_cube.end()), 1e-3f);
}

TEST(GaussianCurvature, OfACubeSitsAtItsCornersOnly) {
  const Mesh mesh = shape(Shape::kCube, 12 * 16);  // 4 x 4 squares a side
  const Topology topology = build_topology(mesh);
  const std::vector<float> curvature = gaussian_curvature(mesh, topology);
  const float half = face_bounds(mesh).high.x;
  const float h = half / 2;
  std::size_t corners = 0;
  for (VertexId v = 0; v < curvature.size(); ++v) {
    if (topology.weld[v] != v) continue;
    const Vec3 p = glm::abs(mesh.positions[v]);
    if (std::min({p.x, p.y, p.z}) < half * 0.999f) {
      EXPECT_NEAR(curvature[v], 0.0f, 1e-4f);
      continue;
    }
    // A quarter turn is missing, over a quarter of a square on each of three sides.
    EXPECT_NEAR(curvature[v], 1.5707963f / (0.75f * h * h), 1e-2f);
    ++corners;
  }
  EXPECT_EQ(corners, 8u);
}

TEST(EdgeLevels, ByTagsAreTheMeanOfTheirEnds) {
  Mesh mesh = shape(Shape::kTetrahedron, 4);
  mesh.tags.resize(mesh.positions.size());
  for (std::size_t v = 0; v < mesh.tags.size(); ++v)
    mesh.tags[v] = static_cast<float>(v % 4) * 2.0f - 1.0f;
  const Levelled tagged(mesh);
  const std::vector<float> levels = tagged.levels({}, {.criterion = Criterion::kTags, .max_level = 3}).value();
  for (std::size_t e = 0; e < levels.size(); ++e) {
    const Edge& edge = tagged.topology.edges[e];
    EXPECT_NEAR(levels[e], std::clamp((mesh.tags[edge.v[0]] + mesh.tags[edge.v[1]]) / 2, 0.0f, 3.0f), 1e-6f);
  }
}

TEST(EdgeLevels, RefuseOptionsThatMakeNoSense) {
  const Levelled cube(shape(Shape::kCube, 12));
  const auto code_of = [&](const LevelOptions& options, const View& view = {{Vec3(0, 0, 5), false}, 100}) {
    const auto levels = cube.levels(view, options);
    return levels ? std::string("none") : levels.error().message;
  };
  EXPECT_NE(code_of({.max_level = 9}).find("out of range"), std::string::npos);
  EXPECT_NE(code_of({.max_level = -1}).find("out of range"), std::string::npos);
  EXPECT_NE(code_of({.pixels = -1.0f}).find("negative"), std::string::npos);
  EXPECT_NE(code_of({.pixels = NAN}).find("not a number"), std::string::npos);
  EXPECT_NE(code_of({.pixels = 1.0f}, View{}).find("picture's size"), std::string::npos);
  EXPECT_NE(code_of({.criterion = Criterion::kTags}).find("no vertex tags"), std::string::npos);
  EXPECT_NE(code_of({.criterion = Criterion::kDistance}, {{Vec3(0, 0, 1), true}, 1}).find("eye at a point"),
            std::string::npos);
  EXPECT_NE(code_of({.criterion = Criterion::kDistance, .near_distance = 3, .far_distance = 2}).find("out of order"),
            std::string::npos);
  EXPECT_NE(code_of({.wedge = {Wedge::Rule::kAngle, 2.0f}}).find("wedge"), std::string::npos);
}

}  // namespace
}  // namespace limn
