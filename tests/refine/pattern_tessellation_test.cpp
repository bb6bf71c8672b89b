// tessellate() by patterns: both families against their points computed one by one, and what moves where a level
// crosses an integer.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <map>
#include <set>

#include "limn/base/parallel.h"
#include "limn/base/random.h"
#include "limn/mesh/normals.h"
#include "limn/mesh/shapes.h"
#include "limn/refine/refine.h"

#include "refine/random_levels.h"
#include "support/checks.h"
#include "support/stable.h"

namespace limn {
namespace {

constexpr PatternFamily kFamilies[] = {PatternFamily::kNested, PatternFamily::kMinimal};

int rounded_up(float level) {
  return static_cast<int>(std::ceil(level));
}

bool is_before(const Vec3& a, const Vec3& b) {
  return std::tuple(a.x, a.y, a.z) < std::tuple(b.x, b.y, b.z);
}

struct PointSets {
  std::vector<Vec3> edges;  ///< the corners and every edge's points at its t
  std::vector<Vec3> grids;  ///< inside all faces, at the vertices of the grid P_m
};

/// Every point a tessellation may have, from the definitions, face by face.
PointSets expected_points(const Refiner& refiner, std::span<const float> levels, const Refinement& result,
                          PatternFamily family, Blend blend) {
  const Mesh& mesh = refiner.mesh();
  const Topology& topology = refiner.topology();
  PointSets points;
  std::set<VertexId> corners;
  std::vector<Vec3> curve, surface;
  const auto sample = [&](EdgeId e, int t) {
    curve.resize((std::size_t{1} << t) + 1);
    surface.resize(curve.size());
    const Edge& edge = topology.edges[e];
    sample_edge(mesh.positions[edge.v[0]], refiner.curves()[e], mesh.positions[edge.v[1]], levels[e], t, blend, curve,
                surface);
  };
  for (EdgeId e = 0; e < topology.edge_count(); ++e) {
    int t = rounded_up(levels[e]);
    if (family == PatternFamily::kNested) {
      for (const FaceId f : topology.edge_faces(e))
        t = std::max<int>(t, result.face_level[f]);
    }
    sample(e, t);
    points.edges.insert(points.edges.end(), surface.begin() + 1, surface.end() - 1);
    corners.insert({topology.edges[e].v[0], topology.edges[e].v[1]});
  }
  for (const VertexId v : corners)
    points.edges.push_back(mesh.positions[v]);
  for (FaceId f = 0; f < topology.face_count(); ++f) {
    if (topology.face_edges[f][0] == kInvalidId) continue;
    const Grid grid = make_grid(result.face_level[f]);
    const int n = grid.segments();
    std::vector<Vec3> patch_points(grid.vertices.size()), surface_points(grid.vertices.size());
    float largest = 0;
    for (int c = 0; c < 3; ++c) {
      const EdgeId e = topology.face_edges[f][static_cast<std::size_t>(c)];
      largest = std::max(largest, levels[e]);
      sample(e, grid.level);
      for (int q = 0; q <= n; ++q) {
        const auto k = static_cast<std::size_t>(topology.runs_forward(f, c) ? q : n - q);
        patch_points[grid.on_side(c, q)] = curve[k];
        surface_points[grid.on_side(c, q)] = surface[k];
      }
    }
    sample_interior(grid, make_patch(mesh, topology, refiner.curves(), f, CenterRule::kPn), largest, blend,
                    patch_points, surface_points);
    for (const std::uint32_t v : grid.interior)
      points.grids.push_back(surface_points[v]);
  }
  return points;
}

TEST(PatternTessellation, OfTheNestedFamilyHasThePointsOfItsGridsAndEdgesBitForBit) {
  Random random(21);
  for (const test::StableMesh& item : test::awkward_meshes()) {
    for (const Blend blend : {Blend::kSurplus, Blend::kPaper}) {
      const auto refiner = Refiner::create(item.mesh, {.blend = blend});
      if (!refiner) continue;
      const std::vector<float> levels = random_levels(random, refiner->topology().edge_count(), 4);
      const Refinement result = refiner->refine_with(levels).value();
      PointSets expected = expected_points(*refiner, levels, result, PatternFamily::kNested, blend);
      expected.edges.insert(expected.edges.end(), expected.grids.begin(), expected.grids.end());
      std::sort(expected.edges.begin(), expected.edges.end(), is_before);
      std::vector<Vec3> points = result.mesh.positions;
      std::sort(points.begin(), points.end(), is_before);
      EXPECT_EQ(points, expected.edges) << item.name;
    }
  }
}

TEST(PatternTessellation, OfTheMinimalFamilyHasItsOwnSegmentsAndPointsOfTheNestedSurfaceInside) {
  Random random(22);
  for (const test::StableMesh& item : test::awkward_meshes()) {
    for (const Blend blend : {Blend::kSurplus, Blend::kPaper}) {
      const auto refiner = Refiner::create(item.mesh, {.blend = blend, .family = PatternFamily::kMinimal});
      if (!refiner) continue;
      const std::vector<float> levels = random_levels(random, refiner->topology().edge_count(), 4);
      const Refinement result = refiner->refine_with(levels).value();
      PointSets expected = expected_points(*refiner, levels, result, PatternFamily::kMinimal, blend);
      std::sort(expected.grids.begin(), expected.grids.end(), is_before);
      std::sort(expected.edges.begin(), expected.edges.end(), is_before);
      const auto inside = result.mesh.positions.begin() + static_cast<std::ptrdiff_t>(expected.edges.size());
      std::vector<Vec3> on_edges(result.mesh.positions.begin(), inside);
      std::sort(on_edges.begin(), on_edges.end(), is_before);
      EXPECT_EQ(on_edges, expected.edges) << item.name;
      std::vector<Vec3> others(inside, result.mesh.positions.end());
      std::sort(others.begin(), others.end(), is_before);
      EXPECT_TRUE(std::includes(expected.grids.begin(), expected.grids.end(), others.begin(), others.end(), is_before))
          << item.name;
    }
  }
}

TEST(PatternTessellation, KeepsClosedMeshesClosedInBothFamilies) {
  Random random(23);
  for (const Shape kind : {Shape::kIcosphere, Shape::kTorus, Shape::kKnot, Shape::kHoles3, Shape::kAsteroid,
                           Shape::kCube, Shape::kTetrahedron}) {
    const Mesh mesh = make_shape(kind, {.faces = 400}).value();
    for (const PatternFamily family : kFamilies) {
      const Refiner refiner = Refiner::create(mesh, {.family = family}).value();
      for (int round = 0; round < 4; ++round) {
        const std::vector<float> levels = random_levels(random, refiner.topology().edge_count(), 4);
        const Mesh refined = refiner.refine_with(levels).value().mesh;
        test::expect_well_formed(refined);
        test::expect_closed(refined);
        EXPECT_GT(test::signed_volume(refined), 0.0);
      }
    }
  }
}

/// Edges by index with the number of faces at them.
std::map<int, std::size_t> edges_by_faces(const Mesh& mesh) {
  std::map<std::pair<VertexId, VertexId>, int> uses;
  for (const Triangle& t : mesh.faces) {
    for (std::size_t c = 0; c < 3; ++c)
      ++uses[std::minmax(t[c], t[(c + 1) % 3])];
  }
  std::map<int, std::size_t> edges;
  for (const auto& [ends, count] : uses)
    ++edges[count];
  return edges;
}

TEST(PatternTessellation, OfTheMinimalFamilyOpensNoAwkwardMesh) {
  Random random(24);
  int tried = 0;
  for (const test::StableMesh& item : test::awkward_meshes()) {
    const auto refiner = Refiner::create(item.mesh, {.family = PatternFamily::kMinimal});
    if (!refiner) continue;
    ++tried;
    const Topology& topology = refiner->topology();
    // Each input edge with n faces becomes 2^t segments with n faces, and every segment inside a face has two: unless
    // two faces share two edges, and thus perhaps a segment inside both.
    const std::vector<float> levels = random_levels(random, topology.edge_count(), 3);
    std::map<int, std::size_t> expected;
    for (EdgeId e = 0; e < topology.edge_count(); ++e) {
      expected[static_cast<int>(topology.edge_faces(e).size())] += std::size_t{1} << rounded_up(levels[e]);
    }
    const Mesh mesh = refiner->refine_with(levels).value().mesh;
    test::expect_well_formed(mesh);
    EXPECT_EQ(edges_by_faces(mesh)[1], expected[1]) << item.name;
  }
  EXPECT_GE(tried, 20);
}

TEST(PatternTessellation, GivesTheCountsOfItsPatternsInTheirOrder) {
  const Mesh mesh = make_shape(Shape::kTorus, {.faces = 300}).value();
  Random random(25);
  for (const PatternFamily family : kFamilies) {
    const Refiner refiner = Refiner::create(mesh, {.family = family}).value();
    const std::vector<float> levels = random_levels(random, refiner.topology().edge_count(), 4);
    const Refinement result = refiner.refine_with(levels).value();
    std::size_t triangles = 0;
    for (FaceId f = 0; f < refiner.topology().face_count(); ++f) {
      PatternConfig config{result.face_level[f], {}};
      for (std::size_t c = 0; c < 3; ++c) {
        const EdgeId e = refiner.topology().face_edges[f][c];
        int t = rounded_up(levels[e]);
        if (family == PatternFamily::kNested) {
          for (const FaceId other : refiner.topology().edge_faces(e))
            t = std::max<int>(t, result.face_level[other]);
        }
        config.sides[c] = static_cast<std::uint8_t>(t);
      }
      const PatternChoice choice = choose_pattern(family, config);
      const std::size_t count = make_pattern(family, pattern_config(family, choice.base)).triangles.size();
      for (std::size_t n = 0; n < count; ++n)
        ASSERT_EQ(result.source_face[triangles + n], f);
      triangles += count;
    }
    EXPECT_EQ(result.mesh.faces.size(), triangles);
  }
}

TEST(PatternTessellation, OfTheMinimalFamilyIsTheSameForAnyNumberOfThreads) {
  const Mesh mesh = make_shape(Shape::kAsteroid, {.faces = 20000}).value();
  const View view{{Vec3(0, 0, 4), false}, 500};
  const RefineOptions options{.family = PatternFamily::kMinimal};
  const Refinement many = refine(mesh, view, options).value();
  const ThreadLimit one(1);
  test::expect_same_bits(many.mesh, refine(mesh, view, options).value().mesh);
}

/// A random face with edges of length near 1 and strongly turned normals. Texture coordinates are the parameters.
Mesh curved_face(Random& random) {
  Mesh mesh;
  for (int i = 0; i < 3; ++i) {
    const float angle = 2.0943951f * static_cast<float>(i) + static_cast<float>(random.uniform(-0.3, 0.3));
    mesh.positions.emplace_back(std::cos(angle), std::sin(angle), 0.1f * static_cast<float>(random.uniform()));
  }
  mesh.faces = {{0, 1, 2}};
  const Vec3 normal = face_normals(mesh)[0];
  for (int i = 0; i < 3; ++i)
    mesh.normals.values.push_back(glm::normalize(normal + 0.7f * random.direction()));
  mesh.uvs.values = {{0, 0}, {1, 0}, {0, 1}};
  return mesh;
}

double mean_edge(const Mesh& mesh) {
  double sum = 0;
  for (std::size_t c = 0; c < 3; ++c)
    sum += double{glm::length(mesh.positions[(c + 1) % 3] - mesh.positions[c])} / 3;
  return sum;
}

/// The piecewise linear surface at a parameter, by a search through all triangles.
DVec3 surface_at(const Mesh& mesh, const glm::dvec2& at) {
  for (FaceId f = 0; f < mesh.faces.size(); ++f) {
    const glm::dvec2 a = mesh.corner(mesh.uvs, f, 0);
    const glm::dvec2 ab = glm::dvec2(mesh.corner(mesh.uvs, f, 1)) - a;
    const glm::dvec2 ac = glm::dvec2(mesh.corner(mesh.uvs, f, 2)) - a;
    const glm::dvec2 ap = at - a;
    const double area = ab.x * ac.y - ab.y * ac.x;
    const double wb = (ap.x * ac.y - ap.y * ac.x) / area;
    const double wc = (ab.x * ap.y - ab.y * ap.x) / area;
    if (wb < 0 || wc < 0 || wb + wc > 1) continue;
    return DVec3(mesh.positions[mesh.faces[f][0]]) * (1 - wb - wc) + DVec3(mesh.positions[mesh.faces[f][1]]) * wb +
           DVec3(mesh.positions[mesh.faces[f][2]]) * wc;
  }
  ADD_FAILURE() << "no triangle holds " << at.x << ", " << at.y;
  return DVec3(0);
}

struct Jump {
  double inside = 0, on_border = 0;
};

/// The largest moves of the surface when the level of one side goes from an integer to just above it.
Jump jump(const Refiner& refiner, std::vector<float> levels, std::size_t side, int integer) {
  levels[side] = static_cast<float>(integer);
  const Mesh at = refiner.refine_with(levels).value().mesh;
  levels[side] += 1e-6f;
  const Mesh above = refiner.refine_with(levels).value().mesh;
  Jump jump;
  for (int k = 0; k <= 32; ++k) {
    for (int j = 0; j + k <= 32; ++j) {
      const glm::dvec2 parameter(j / 32.0, k / 32.0);
      const double moved = glm::length(surface_at(at, parameter) - surface_at(above, parameter));
      double& largest = j == 0 || k == 0 || j + k == 32 ? jump.on_border : jump.inside;
      largest = std::max(largest, moved / mean_edge(refiner.mesh()));
    }
  }
  return jump;
}

struct Jumps {
  double mean = 0, largest = 0, on_border = 0;
};

Jumps jumps_of(PatternFamily family) {
  constexpr int kFaces = 300;
  Random random(26);
  Jumps jumps;
  for (int n = 0; n < kFaces; ++n) {
    const Refiner refiner = Refiner::create(curved_face(random), {.family = family}).value();
    std::vector<float> levels(3);
    for (float& level : levels)
      level = static_cast<float>(random.uniform(0.0, 3.0));
    const Jump one = jump(refiner, levels, random.below(3), static_cast<int>(random.below(3)));
    jumps.mean += one.inside / kFaces;
    jumps.largest = std::max(jumps.largest, one.inside);
    jumps.on_border = std::max(jumps.on_border, one.on_border);
  }
  return jumps;
}

TEST(PatternTessellation, OfTheMinimalFamilyJumpsInsideAsDocumentedAndNeverOnEdges) {
  const Jumps nested = jumps_of(PatternFamily::kNested);
  const Jumps minimal = jumps_of(PatternFamily::kMinimal);
  std::printf("a level crosses an integer, share of the edge: nested inside %.1e, on edges %.1e\n", nested.largest,
              nested.on_border);
  std::printf("minimal inside: mean %.4f, largest %.4f, on edges %.1e\n", minimal.mean, minimal.largest,
              minimal.on_border);
  EXPECT_LT(std::max({nested.largest, nested.on_border, minimal.on_border}), 2e-6);
  EXPECT_GT(minimal.mean, 0.0);
  EXPECT_LT(minimal.mean, 0.03);
  EXPECT_LT(minimal.largest, 0.10);
}

}  // namespace
}  // namespace limn
