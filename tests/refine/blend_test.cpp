#include "limn/refine/blend.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "limn/base/random.h"
#include "limn/mesh/normals.h"
#include "limn/refine/levels.h"

namespace limn {
namespace {

/// One curved face of edge length near 1, ready to be sampled at any three levels.
struct CurvedFace {
  Mesh mesh;
  Topology topology;
  std::vector<EdgeCurve> curves;
  Patch patch;
  float mean_edge = 0;
};

CurvedFace curved_face(Random& random) {
  CurvedFace face;
  for (int i = 0; i < 3; ++i) {
    const float angle = 2.0943951f * static_cast<float>(i) + static_cast<float>(random.uniform(-0.3, 0.3));
    face.mesh.positions.emplace_back(std::cos(angle), std::sin(angle), 0.1f * static_cast<float>(random.uniform()));
  }
  face.mesh.faces = {{0, 1, 2}};
  const Vec3 normal = face_normals(face.mesh)[0];
  for (int i = 0; i < 3; ++i)
    face.mesh.normals.values.push_back(glm::normalize(normal + 0.7f * random.direction()));
  face.topology = build_topology(face.mesh);
  face.curves = edge_curves(face.mesh, face.topology);
  face.patch = make_patch(face.mesh, face.topology, face.curves, 0, CenterRule::kPn);
  for (const Edge& edge : face.topology.edges) {
    face.mean_edge += glm::length(face.mesh.positions[edge.v[0]] - face.mesh.positions[edge.v[1]]) / 3;
  }
  return face;
}

struct Sampled {
  Grid grid;
  std::vector<Vec3> patch_points, surface_points;
};

/// The tessellation at levels s of its three sides.
Sampled sample(const CurvedFace& face, const std::array<float, 3>& s, Blend blend) {
  const float largest = std::max({s[0], s[1], s[2]});
  Sampled result{make_grid(static_cast<int>(std::ceil(largest))), {}, {}};
  const int n = result.grid.segments();
  result.patch_points.resize(result.grid.vertices.size());
  result.surface_points.resize(result.grid.vertices.size());
  std::vector<Vec3> curve(static_cast<std::size_t>(n) + 1);
  std::vector<Vec3> surface(curve.size());
  for (int c = 0; c < 3; ++c) {
    const EdgeId e = face.topology.face_edges[0][static_cast<std::size_t>(c)];
    const Edge& edge = face.topology.edges[e];
    sample_edge(face.mesh.positions[edge.v[0]], face.curves[e], face.mesh.positions[edge.v[1]],
                s[static_cast<std::size_t>(c)], result.grid.level, blend, curve, surface);
    for (int q = 0; q <= n; ++q) {
      const auto k = static_cast<std::size_t>(face.topology.runs_forward(0, c) ? q : n - q);
      result.patch_points[result.grid.on_side(c, q)] = curve[k];
      result.surface_points[result.grid.on_side(c, q)] = surface[k];
    }
  }
  sample_interior(result.grid, face.patch, largest, blend, result.patch_points, result.surface_points);
  return result;
}

/// The piecewise linear surface at (j, k) / 32, by a search through all triangles.
Vec3 surface_at(const Sampled& s, int j, int k) {
  const double scale = static_cast<double>(s.grid.segments()) / 32;
  const double x = j * scale;
  const double y = k * scale;
  for (const auto& t : s.grid.triangles) {
    const GridVertex& a = s.grid.vertices[t[0]];
    const GridVertex& b = s.grid.vertices[t[1]];
    const GridVertex& c = s.grid.vertices[t[2]];
    const double wb = (x - a.j) * (c.k - a.k) - (y - a.k) * (c.j - a.j);
    const double wc = (b.j - a.j) * (y - a.k) - (b.k - a.k) * (x - a.j);
    if (wb < 0 || wc < 0 || wb + wc > 1) continue;
    return Vec3(DVec3(s.surface_points[t[0]]) * (1 - wb - wc) + DVec3(s.surface_points[t[1]]) * wb +
                DVec3(s.surface_points[t[2]]) * wc);
  }
  ADD_FAILURE() << "no triangle holds " << j << ", " << k;
  return Vec3(0);
}

double largest_distance(const Sampled& a, const Sampled& b) {
  double largest = 0;
  for (int k = 0; k <= 32; ++k) {
    for (int j = 0; j + k <= 32; ++j) {
      largest = std::max(largest, static_cast<double>(glm::length(surface_at(a, j, k) - surface_at(b, j, k))));
    }
  }
  return largest;
}

/// The largest move of the surface, over the mean edge, when the first level crosses an integer by ±1e-7.
double jump(const CurvedFace& face, int integer, float second, float third, Blend blend) {
  const float below = static_cast<float>(integer) * (1 - 1e-7f);
  const float above = static_cast<float>(integer) * (1 + 1e-7f);
  EXPECT_LT(below, static_cast<float>(integer));
  EXPECT_GT(above, static_cast<float>(integer));
  return largest_distance(sample(face, {below, second, third}, blend), sample(face, {above, second, third}, blend)) /
         face.mean_edge;
}

TEST(Blend, PaperJumpsWhereTheLargestLevelCrossesAnIntegerAndSurplusDoesNot) {
  Random random(6);
  double paper = 0;
  double surplus = 0;
  for (int n = 0; n < 40; ++n) {
    const CurvedFace face = curved_face(random);
    for (const int integer : {1, 2}) {
      for (const float other : {0.0f, 0.4f}) {
        paper = std::max(paper, jump(face, integer, other, 0.0f, Blend::kPaper));
        surplus = std::max(surplus, jump(face, integer, other, 0.0f, Blend::kSurplus));
      }
    }
  }
  std::printf("largest jump at an integer level, share of the edge: paper %.4f, surplus %.2e\n", paper, surplus);
  RecordProperty("paper", std::to_string(paper));
  RecordProperty("surplus", std::to_string(surplus));
  EXPECT_GT(paper, 0.02);
  EXPECT_LE(surplus, 1e-6);
}

TEST(Blend, SurplusIsContinuousInEveryLevel) {
  Random random(7);
  constexpr float kStep = 1e-3f;
  for (int n = 0; n < 60; ++n) {
    const CurvedFace face = curved_face(random);
    std::array<float, 3> s{};
    for (float& level : s)
      level = static_cast<float>(random.uniform(0.0, 3.0));
    std::array<float, 3> moved = s;
    moved[random.below(3)] += kStep;
    // Each level moves the surface by no more than the curve's own size, times the step.
    EXPECT_LT(largest_distance(sample(face, s, Blend::kSurplus), sample(face, moved, Blend::kSurplus)), 2 * kStep);
  }
}

TEST(Blend, BothAreThePatchItselfAtEqualIntegerLevels) {
  Random random(8);
  for (const Blend blend : {Blend::kPaper, Blend::kSurplus}) {
    const CurvedFace face = curved_face(random);
    for (int m = 0; m <= 4; ++m) {
      const float s = static_cast<float>(m);
      const Sampled sampled = sample(face, {s, s, s}, blend);
      EXPECT_EQ(sampled.surface_points, sampled.patch_points);
    }
  }
}

TEST(Blend, BothAreTheFlatTriangleAtLevelZero) {
  Random random(9);
  const CurvedFace face = curved_face(random);
  for (const Blend blend : {Blend::kPaper, Blend::kSurplus}) {
    EXPECT_LT(largest_distance(sample(face, {0, 0, 0}, blend), sample(face, {1e-6f, 0, 0}, blend)), 2e-6);
  }
}

TEST(Blend, PaperEqualsEquationNineAtEqualLevels) {
  Random random(10);
  for (int n = 0; n < 20; ++n) {
    const CurvedFace face = curved_face(random);
    const auto m = static_cast<float>(random.below(3));
    const float alpha = static_cast<float>(random.uniform(0.05, 0.95));
    const Sampled coarse = sample(face, {m, m, m}, Blend::kPaper);
    const Sampled fine = sample(face, {m + 1, m + 1, m + 1}, Blend::kPaper);
    const Sampled between = sample(face, {m + alpha, m + alpha, m + alpha}, Blend::kPaper);
    const Sampled surplus = sample(face, {m + alpha, m + alpha, m + alpha}, Blend::kSurplus);
    for (int k = 0; k <= 32; k += 4) {
      for (int j = 0; j + k <= 32; j += 4) {
        const Vec3 expected = surface_at(coarse, j, k) * (1 - alpha) + surface_at(fine, j, k) * alpha;
        EXPECT_LT(glm::length(surface_at(between, j, k) - expected), 1e-6f);
        // With one level for all three sides the two blends are one.
        EXPECT_LT(glm::length(surface_at(surplus, j, k) - expected), 1e-6f);
      }
    }
  }
}

}  // namespace
}  // namespace limn
