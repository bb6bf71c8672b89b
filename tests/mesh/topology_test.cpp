#include "limn/mesh/topology.h"

#include <bit>
#include <cmath>
#include <gtest/gtest.h>
#include <map>
#include <tuple>
#include <utility>

#include "limn/base/parallel.h"
#include "limn/base/random.h"

namespace limn {
namespace {

/// Random faces over few vertices on a coarse grid: equal positions, degenerate faces and crowded edges in plenty.
Mesh random_soup(std::uint64_t seed, std::size_t vertices, std::size_t faces) {
  Random random(seed);
  Mesh mesh;
  for (std::size_t i = 0; i < vertices; ++i) {
    const auto coordinate = [&] { return static_cast<float>(random.below(5)) - 2.0f; };
    mesh.positions.emplace_back(coordinate(), coordinate(), coordinate());
    if (random.below(4) == 0) mesh.positions.back().x = -0.0f;
  }
  for (std::size_t i = 0; i < faces; ++i) {
    const auto vertex = [&] { return static_cast<VertexId>(random.below(vertices)); };
    mesh.faces.push_back({vertex(), vertex(), vertex()});
  }
  return mesh;
}

/// Every property of a topology, recomputed from ordered maps.
void expect_equals_oracle(const Mesh& mesh, const Topology& topology) {
  std::map<std::array<float, 3>, VertexId> lowest;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const Vec3 p = mesh.positions[i] + Vec3(0.0f);
    const VertexId first = lowest.try_emplace({p.x, p.y, p.z}, static_cast<VertexId>(i)).first->second;
    ASSERT_EQ(topology.weld[i], first);
  }
  std::map<std::pair<VertexId, VertexId>, std::vector<std::pair<FaceId, bool>>> sides;
  std::vector<FaceId> degenerate;
  for (FaceId f = 0; f < mesh.faces.size(); ++f) {
    Triangle t = mesh.faces[f];
    for (VertexId& v : t)
      v = topology.weld[v];
    ASSERT_EQ(topology.faces[f], t);
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) {
      degenerate.push_back(f);
      EXPECT_EQ(topology.face_edges[f][0], kInvalidId);
      continue;
    }
    for (std::size_t c = 0; c < 3; ++c) {
      const VertexId a = t[c];
      const VertexId b = t[(c + 1) % 3];
      sides[{std::min(a, b), std::max(a, b)}].emplace_back(f, a < b);
    }
  }
  EXPECT_EQ(topology.degenerate_faces, degenerate);
  ASSERT_EQ(topology.edge_count(), sides.size());
  EdgeId id = 0;
  for (const auto& [ends, faces] : sides) {
    const Edge& edge = topology.edges[id];
    ASSERT_EQ(std::pair(edge.v[0], edge.v[1]), ends);
    const std::span<const FaceId> listed = topology.edge_faces(id);
    ASSERT_EQ(listed.size(), faces.size());
    for (const auto& [face, forward] : faces) {
      EXPECT_NE(std::find(listed.begin(), listed.end(), face), listed.end());
      int matches = 0;
      for (int c = 0; c < 3; ++c) {
        if (topology.face_edges[face][static_cast<std::size_t>(c)] != id) continue;
        ++matches;
        EXPECT_EQ(topology.runs_forward(face, c), forward);
      }
      EXPECT_EQ(matches, 1);
    }
    const EdgeClass expected = faces.size() == 1                    ? EdgeClass::kBoundary
                               : faces.size() > 2                   ? EdgeClass::kNonManifold
                               : faces[0].second == faces[1].second ? EdgeClass::kInconsistent
                                                                    : EdgeClass::kManifold;
    EXPECT_EQ(topology.edge_class[id], expected);
    if (expected == EdgeClass::kManifold) {
      EXPECT_EQ(edge.face[0], faces[0].second ? faces[0].first : faces[1].first);
    }
    ++id;
  }
}

TEST(Topology, EqualsTheMapBasedOracleOnRandomSoups) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const Mesh mesh = random_soup(seed, 3 + seed * 4, 1 + seed * seed);
    expect_equals_oracle(mesh, build_topology(mesh));
  }
}

TEST(Topology, IsTheSameForAnyNumberOfThreads) {
  const Mesh mesh = random_soup(7, 40000, 100000);
  const Topology many = build_topology(mesh);
  const ThreadLimit one(1);
  const Topology single = build_topology(mesh);
  EXPECT_EQ(many.weld, single.weld);
  EXPECT_EQ(many.face_edges, single.face_edges);
  EXPECT_EQ(many.edge_class, single.edge_class);
}

TEST(Topology, OfNothingIsEmpty) {
  const Topology topology = build_topology(Mesh{});
  EXPECT_EQ(topology.edge_count(), 0u);
  EXPECT_EQ(topology.face_count(), 0u);
}

TEST(Topology, SortsAFanOfManyFacesAroundOneVertexInTime) {
  Mesh mesh;
  mesh.positions.emplace_back(0, 0, 1);
  constexpr VertexId kRim = 300000;
  for (VertexId i = 0; i < kRim; ++i)
    mesh.positions.emplace_back(static_cast<float>(i), 1, 0);
  for (VertexId i = 1; i < kRim; ++i)
    mesh.faces.push_back({0, i, i + 1});
  EXPECT_EQ(build_topology(mesh).edge_count(), 2u * (kRim - 1) + 1);
}

/// Positions that all fall on one slot of a table hashed as weld_positions() does, by running its hash backwards.
std::vector<Vec3> crowding_positions(std::size_t count) {
  const auto inverse = [](std::uint64_t odd) {
    std::uint64_t result = odd;
    for (int i = 0; i < 5; ++i)
      result *= 2 - odd * result;
    return result;
  };
  std::vector<Vec3> positions;
  for (std::uint64_t high = 1; positions.size() < count; ++high) {
    std::uint64_t x = high << 32;
    x ^= x >> 32;
    x *= inverse(0xd6e8feb86659fd93ull);
    x ^= x >> 32;
    x *= inverse(0x9e3779b97f4a7c15ull);
    const Vec3 p(std::bit_cast<float>(static_cast<std::uint32_t>(x)),
                 std::bit_cast<float>(static_cast<std::uint32_t>(x >> 32)), 0);
    if (std::isfinite(p.x) && std::isfinite(p.y)) positions.push_back(p);
  }
  return positions;
}

void expect_welds_as_a_map(const std::vector<Vec3>& positions) {
  std::map<std::tuple<float, float, float>, VertexId> lowest;
  std::vector<VertexId> expected;
  for (const Vec3& p : positions)
    expected.push_back(lowest.try_emplace({p.x, p.y, p.z}, static_cast<VertexId>(expected.size())).first->second);
  EXPECT_EQ(weld_positions(positions), expected);
}

TEST(WeldPositions, PositionsMadeToCrowdTheTableTakeNoLongerThanASort) {
  expect_welds_as_a_map(crowding_positions(160000));
}

TEST(WeldPositions, JoinsEqualPositionsWhetherTheyCrowdOrNot) {
  expect_welds_as_a_map({});
  Random random(11);
  for (const bool crowded : {false, true}) {
    std::vector<Vec3> positions = crowded ? crowding_positions(3000) : std::vector<Vec3>{};
    for (int i = 0; i < 3000; ++i) {
      const auto coordinate = [&] { return static_cast<float>(random.below(20)) - 10.0f; };
      positions.emplace_back(coordinate(), coordinate(), coordinate());
      if (random.below(4) == 0) positions.back().z = -0.0f;
      positions.push_back(positions[random.below(positions.size())]);
      const std::size_t other = random.below(positions.size());
      std::swap(positions[other], positions.back());
    }
    expect_welds_as_a_map(positions);
  }
}

TEST(WeldPositions, WithToleranceJoinsChainsAndNamesThemByTheirLowest) {
  const std::vector<Vec3> positions{{0, 0, 0},    {5, 0, 0},     {0.09f, 0, 0}, {0.18f, 0, 0},
                                    {5.2f, 0, 0}, {1e30f, 0, 0}, {1e30f, 0, 0}};
  const std::vector<VertexId> expected{0, 1, 0, 0, 4, 5, 5};
  EXPECT_EQ(weld_positions(positions, {.tolerance = 0.1f}), expected);
}

TEST(WeldPositions, WithToleranceEqualsTheQuadraticOracle) {
  Random random(3);
  std::vector<Vec3> positions;
  for (int i = 0; i < 400; ++i)
    positions.push_back(random.direction());
  constexpr float kTolerance = 0.11f;
  std::vector<VertexId> expected(positions.size());
  for (VertexId i = 0; i < expected.size(); ++i)
    expected[i] = i;
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t i = 0; i < positions.size(); ++i) {
      for (std::size_t j = 0; j < positions.size(); ++j) {
        const DVec3 d = DVec3(positions[i]) - DVec3(positions[j]);
        if (d.x * d.x + d.y * d.y + d.z * d.z > double{kTolerance} * double{kTolerance}) continue;
        if (expected[j] < expected[i]) {
          expected[i] = expected[j];
          changed = true;
        }
      }
    }
  }
  EXPECT_EQ(weld_positions(positions, {.tolerance = kTolerance}), expected);
}

}  // namespace
}  // namespace limn
