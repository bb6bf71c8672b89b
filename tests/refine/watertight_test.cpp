// The claim of docs/watertight.md at its full size: ten million vertices on shared edges, none of which differs between
// the two faces that meet there. The soup of the output's triangles is welded by exact position: one differing bit, or
// one T-junction, would leave boundary edges.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <gtest/gtest.h>

#include "limn/base/random.h"
#include "limn/mesh/shapes.h"
#include "limn/refine/refine.h"

namespace limn {
namespace {

std::vector<Mesh> closed_meshes() {
  std::vector<Mesh> meshes;
  for (const Shape kind : {Shape::kIcosphere, Shape::kTorus, Shape::kKnot, Shape::kHoles3, Shape::kAsteroid,
                           Shape::kCube, Shape::kTetrahedron}) {
    meshes.push_back(make_shape(kind, {.faces = 3000}).value());
  }
  // Away from the origin and at odd scales rounding is at its worst.
  meshes.push_back(meshes[2]);
  for (Vec3& p : meshes.back().positions)
    p = p * 0.37f + Vec3(71.3f, -13.7f, 0.003f);
  meshes.push_back(meshes[3]);
  for (Vec3& p : meshes.back().positions)
    p *= 1.7e6f;
  return meshes;
}

std::vector<float> levels_for(Random& random, const Refiner& refiner, int round) {
  const Bounds bounds = face_bounds(refiner.mesh());
  LevelOptions options;
  options.max_level = 1 + static_cast<int>(random.below(4));
  const bool orthographic = random.below(2) == 0;
  const double distance = bounds.diagonal() * random.uniform(0.6, 5.0);
  const Vec3 direction = random.direction();
  const View view{{orthographic ? direction : Vec3(DVec3(bounds.center()) + DVec3(direction) * distance), orthographic},
                  0};
  if (round % 2 == 0) return refiner.refine(view, options).value().edge_levels;
  std::vector<float> levels(refiner.topology().edge_count());
  for (float& level : levels)
    level = static_cast<float>(random.uniform(0.0, options.max_level));
  return levels;
}

/// The triangles without their indices, as a GPU or an STL file has them.
Mesh soup_of(const Mesh& mesh) {
  Mesh soup;
  soup.positions.reserve(3 * mesh.faces.size());
  soup.faces.reserve(mesh.faces.size());
  for (const Triangle& t : mesh.faces) {
    const auto first = static_cast<VertexId>(soup.positions.size());
    for (const VertexId v : t)
      soup.positions.push_back(mesh.positions[v]);
    soup.faces.push_back({first, first + 1, first + 2});
  }
  return soup;
}

std::size_t open_edges(const Mesh& mesh) {
  const Topology topology = build_topology(soup_of(mesh));
  return static_cast<std::size_t>(std::count_if(topology.edge_class.begin(), topology.edge_class.end(),
                                                [](EdgeClass c) { return c != EdgeClass::kManifold; }));
}

/// Horner's nesting, as an evaluator that saves multiplications has it.
Vec3 nested(const Patch& p, float u, float v, float w) {
  const Vec3 third = ((p.b300 * u + (p.b210 * v + p.b201 * w) * 3.0f) * u +
                      ((p.b120 * v + p.b111 * (2.0f * w)) * v + p.b102 * (w * w)) * 3.0f) *
                     u;
  const Vec3 second = ((p.b030 * v + p.b021 * (3.0f * w)) * v + p.b012 * (3.0f * w * w)) * v;
  return third + second + p.b003 * (w * w * w);
}

/// evaluate_patch's own sum as a compiler contracts it when it may fuse multiplications and additions.
Vec3 contracted(const Patch& p, float u, float v, float w) {
  const float weights[10] = {u * u * u,     v * v * v,     w * w * w,     3 * u * u * v, 3 * u * v * v,
                             3 * v * v * w, 3 * v * w * w, 3 * w * w * u, 3 * w * u * u, 6 * u * v * w};
  const Vec3 points[10] = {p.b300, p.b030, p.b003, p.b210, p.b120, p.b021, p.b012, p.b102, p.b201, p.b111};
  Vec3 sum(0);
  for (std::size_t i = 0; i < 10; ++i) {
    for (int axis = 0; axis < 3; ++axis)
      sum[axis] = std::fma(points[i][axis], weights[i], sum[axis]);
  }
  return sum;
}

struct Counts {
  std::size_t points = 0;
  std::size_t differing = 0;
};

/// The control: each face evaluates its own patch along the edge. Over the points of every edge at its finer side's
/// level.
template <class Evaluate>
Counts per_patch_evaluation(const Refiner& refiner, const Refinement& refinement, const Evaluate& evaluate) {
  const Topology& topology = refiner.topology();
  Counts counts;
  for (EdgeId e = 0; e < topology.edge_count(); ++e) {
    const Edge& edge = topology.edges[e];
    const int t = std::max(refinement.face_level[edge.face[0]], refinement.face_level[edge.face[1]]);
    const Patch patches[2] = {make_patch(refiner.mesh(), topology, refiner.curves(), edge.face[0], CenterRule::kPn),
                              make_patch(refiner.mesh(), topology, refiner.curves(), edge.face[1], CenterRule::kPn)};
    for (int k = 1; k < 1 << t; ++k) {
      Vec3 points[2];
      for (std::size_t side = 0; side < 2; ++side) {
        const Triangle& face = topology.faces[edge.face[side]];
        float weights[3];
        for (std::size_t c = 0; c < 3; ++c) {
          const float x = static_cast<float>(k) / static_cast<float>(1 << t);
          weights[c] = face[c] == edge.v[0] ? 1 - x : face[c] == edge.v[1] ? x : 0.0f;
        }
        points[side] = evaluate(patches[side], weights[0], weights[1], weights[2]);
      }
      ++counts.points;
      counts.differing += points[0] != points[1];
    }
  }
  return counts;
}

void add(Counts& sum, const Counts& counts) {
  sum.points += counts.points;
  sum.differing += counts.differing;
}

double percent(const Counts& counts) {
  return 100.0 * static_cast<double>(counts.differing) / static_cast<double>(counts.points);
}

TEST(Watertight, TenMillionSharedVerticesWithoutAMismatchWherePlainEvaluationFails) {
  const std::vector<Mesh> meshes = closed_meshes();
  Random random(2008);
  Counts ours, horner, fused, fixed;
  std::size_t triangles = 0;
  for (int round = 0; ours.points < 10'000'000; ++round) {
    const Mesh& mesh = meshes[static_cast<std::size_t>(round) % meshes.size()];
    RefineOptions options;
    options.blend = random.below(4) == 0 ? Blend::kPaper : Blend::kSurplus;
    options.center = random.below(2) == 0 ? CenterRule::kMean : CenterRule::kPn;
    const Refiner refiner = Refiner::create(mesh, options).value();
    const Refinement refinement = refiner.refine_with(levels_for(random, refiner, round)).value();
    for (const Edge& edge : refiner.topology().edges) {
      const int t = std::max(refinement.face_level[edge.face[0]], refinement.face_level[edge.face[1]]);
      ours.points += (std::size_t{1} << t) - 1;
    }
    ours.differing += open_edges(refinement.mesh);
    triangles += refinement.mesh.faces.size();
    if (round >= 2 * static_cast<int>(meshes.size())) continue;
    add(horner, per_patch_evaluation(refiner, refinement, nested));
    add(fixed, per_patch_evaluation(refiner, refinement, evaluate_patch));
    add(fused, per_patch_evaluation(refiner, refinement, contracted));
  }
  std::printf("%zu vertices on shared edges, %zu triangles: %zu mismatches\n", ours.points, triangles, ours.differing);
  std::printf(
      "each face by itself, %zu vertices: nested sum %.1f %% differ, fused Bernstein sum %.1f %%, in one fixed order "
      "%.1f %%\n",
      horner.points, percent(horner), percent(fused), percent(fixed));
  EXPECT_EQ(ours.differing, 0u);
  EXPECT_GT(percent(horner), 25.0);
  EXPECT_GT(percent(fused), 25.0);
}

}  // namespace
}  // namespace limn
