#include <algorithm>
#include <array>
#include <cstdint>
#include <gtest/gtest.h>
#include <limits>
#include <vector>

#include "limn/base/parallel.h"
#include "limn/base/random.h"
#include "limn/hull/intersection_tree.h"
#include "limn/hull/self_intersections.h"
#include "limn/hull/shell.h"
#include "limn/mesh/shapes.h"

#include "hull/random_steps.h"
#include "support/stable.h"

namespace limn::test {
namespace {

using IVec3 = std::array<std::int64_t, 3>;
using Points = std::vector<IVec3>;

IVec3 operator-(const IVec3& a, const IVec3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
IVec3 cross(const IVec3& a, const IVec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
std::int64_t dot(const IVec3& a, const IVec3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

bool separates(const IVec3& axis, const Points& a, const Points& b) {
  const auto range = [&](const Points& points) {
    std::int64_t low = std::numeric_limits<std::int64_t>::max(), high = std::numeric_limits<std::int64_t>::min();
    for (const IVec3& p : points) {
      low = std::min(low, dot(axis, p));
      high = std::max(high, dot(axis, p));
    }
    return std::pair(low, high);
  };
  const auto [la, ha] = range(a);
  const auto [lb, hb] = range(b);
  return ha < lb || hb < la;
}

/// The hulls of two sets of points in whole numbers, apart where an axis that their nearest points could lie on
/// separates them: any direction between points, across two such, or across one and in a plane with another.
bool hulls_meet(const Points& a, const Points& b) {
  Points all = a;
  all.insert(all.end(), b.begin(), b.end());
  Points directions;
  for (const IVec3& p : all) {
    for (const IVec3& q : all)
      directions.push_back(p - q);
  }
  for (const IVec3& d : directions) {
    if (separates(d, a, b)) return false;
    for (const IVec3& e : directions) {
      const IVec3 n = cross(d, e);
      if (separates(n, a, b) || separates(cross(d, n), a, b)) return false;
    }
  }
  return true;
}

/// Finer than any two of the points used can lead to.
constexpr std::int64_t kUnit = 1024;

IVec3 scaled(const IVec3& p) {
  return {kUnit * p[0], kUnit * p[1], kUnit * p[2]};
}

/// A little of the way from one point to another. \pre both scaled
IVec3 towards(const IVec3& from, const IVec3& to) {
  return {from[0] + (to[0] - from[0]) / kUnit, from[1] + (to[1] - from[1]) / kUnit,
          from[2] + (to[2] - from[2]) / kUnit};
}

/// Triangle a without the neighbourhood of what it shares with b, against b.
bool meet_beyond_shared(const std::array<IVec3, 3>& a, const std::array<IVec3, 3>& b) {
  Points kept, shared, whole;
  for (const IVec3& p : a)
    (std::find(b.begin(), b.end(), p) != b.end() ? shared : kept).push_back(scaled(p));
  for (const IVec3& p : b)
    whole.push_back(scaled(p));
  if (shared.size() == 3) return true;
  Points cut = kept;
  for (const IVec3& s : shared) {
    for (const IVec3& k : kept)
      cut.push_back(towards(s, k));
  }
  return hulls_meet(cut, whole);
}

bool is_line(const std::array<IVec3, 3>& t) {
  return cross(t[1] - t[0], t[2] - t[0]) == IVec3{0, 0, 0};
}

Corners corners_of(const std::array<IVec3, 3>& t) {
  Corners corners;
  for (std::size_t i = 0; i < 3; ++i)
    corners[i] = Vec3(static_cast<float>(t[i][0]), static_cast<float>(t[i][1]), static_cast<float>(t[i][2]));
  return corners;
}

TEST(TriangleIntersection, AgreesWithSeparatingAxesOnSmallWholeNumbers) {
  Random random(2);
  std::array<std::array<std::size_t, 2>, 4> met{};
  for (int round = 0; round < 30000; ++round) {
    std::array<std::array<IVec3, 3>, 2> t;
    for (auto& triangle : t) {
      for (IVec3& p : triangle) {
        for (std::int64_t& x : p)
          x = static_cast<std::int64_t>(random.below(round % 2 == 0 ? 4 : 9));
      }
    }
    const std::uint64_t share = random.below(4);
    if (share > 0) t[1][random.below(3)] = t[0][0];
    if (share > 1) t[1][random.below(3)] = t[0][1];
    std::size_t shared = 0;
    for (const IVec3& p : t[0])
      shared += static_cast<std::size_t>(std::count(t[1].begin(), t[1].end(), p));
    if (shared > 0 && (is_line(t[0]) || is_line(t[1]))) continue;
    const bool meet = meet_beyond_shared(t[0], t[1]);
    ++met[std::min<std::size_t>(shared, 3)][meet ? 1 : 0];
    ASSERT_EQ(intersect_beyond_shared(corners_of(t[0]), corners_of(t[1])), meet) << round;
    ASSERT_EQ(intersect_beyond_shared(corners_of(t[1]), corners_of(t[0])), meet) << round;
  }
  for (std::size_t shared = 0; shared < 3; ++shared) {
    EXPECT_GT(met[shared][0], 50u) << shared;
    EXPECT_GT(met[shared][1], 50u) << shared;
  }
}

std::vector<FacePair> all_pairs(std::span<const Vec3> positions, std::span<const Triangle> faces) {
  const auto corners = [&](FaceId face) {
    const Triangle& t = faces[face];
    return Corners{positions[t[0]], positions[t[1]], positions[t[2]]};
  };
  std::vector<FacePair> pairs;
  for (FaceId a = 0; a < faces.size(); ++a) {
    for (FaceId b = a + 1; b < faces.size(); ++b) {
      if (intersect_beyond_shared(corners(a), corners(b))) pairs.push_back({a, b});
    }
  }
  return pairs;
}

TEST(SelfIntersections, AreThoseOfAllPairsOnTheStable) {
  for (const StableMesh& entry : awkward_meshes()) {
    if (entry.mesh.faces.size() > 500) continue;
    EXPECT_EQ(self_intersections(entry.mesh.positions, entry.mesh.faces),
              all_pairs(entry.mesh.positions, entry.mesh.faces))
        << entry.name;
  }
}

TEST(SelfIntersections, AreFoundWhereSolidsCross) {
  Mesh mesh = *make_shape(Shape::kTorus, {.faces = 400});
  EXPECT_TRUE(self_intersections(mesh.positions, mesh.faces).empty());
  const std::size_t count = mesh.positions.size(), faces = mesh.faces.size();
  for (std::size_t v = 0; v < count; ++v)
    mesh.positions.push_back(mesh.positions[v] + Vec3(0.13f, 0.07f, 0.011f));
  for (std::size_t f = 0; f < faces; ++f) {
    Triangle t = mesh.faces[f];
    for (VertexId& v : t)
      v += static_cast<VertexId>(count);
    mesh.faces.push_back(t);
  }
  const auto pairs = self_intersections(mesh.positions, mesh.faces);
  EXPECT_GT(pairs.size(), 50u);
  EXPECT_EQ(pairs, all_pairs(mesh.positions, mesh.faces));
  const ThreadLimit one(1);
  EXPECT_EQ(self_intersections(mesh.positions, mesh.faces), pairs);
}

TEST(IntersectionTree, FollowsASurfaceThatChanges) {
  const Shell shell = *make_shell(*make_shape(Shape::kHoles3, {.faces = 600}));
  IntersectionTree tree(shell.positions, shell.faces);
  StepReplay replay(shell.positions, shell.faces);
  StepChanges changes;
  const auto corners_at = [&](FaceId face) {
    const Triangle& t = replay.faces()[face];
    return Corners{replay.positions()[t[0]], replay.positions()[t[1]], replay.positions()[t[2]]};
  };
  Random random(3);
  std::size_t hits = 0, misses = 0, steps = 0;
  for (const HullStep& step : random_steps(shell, 60, 5)) {
    if (step.kind == HullStep::Kind::kCut) break;  // the tree has no room for new faces
    replay.apply(step, changes);
    for (FaceId face = 0; face < shell.faces.size(); ++face) {
      if (!replay.is_alive(face)) {
        tree.remove(face);
      } else if (corners_at(face) != tree.corners(face)) {
        tree.update(face, corners_at(face));
      }
    }
    if (++steps % 5 != 0) continue;
    const Vec3 at = replay.positions()[random.below(shell.positions.size())];
    const Corners probe{at + 0.1f * random.direction(), at + 0.1f * random.direction(), at + 0.1f * random.direction()};
    std::vector<FaceId> ignored;
    bool expected = false;
    for (FaceId face = 0; face < shell.faces.size(); ++face) {
      if (!replay.is_alive(face) || !intersect_beyond_shared(probe, corners_at(face))) continue;
      if (random.below(4) != 0) {
        ignored.push_back(face);
      } else {
        expected = true;
      }
    }
    (expected ? hits : misses) += 1;
    EXPECT_EQ(tree.hits(std::span(&probe, 1), ignored), expected);
  }
  EXPECT_GT(hits, 5u);
  EXPECT_GT(misses, 5u);
}

TEST(IntersectionTree, HoldsNewTrianglesAgainstEachOther) {
  const IntersectionTree nothing({}, {});
  const std::array<Corners, 2> apart{
      {{Vec3(0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, {Vec3(0), Vec3(0, 1, 0), Vec3(-1, 0, 0)}}};
  const std::array<Corners, 2> folded{
      {{Vec3(0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, {Vec3(0), Vec3(0, 1, 0), Vec3(1, 1, 0)}}};
  EXPECT_FALSE(nothing.hits(apart, {}));
  EXPECT_TRUE(nothing.hits(folded, {}));
}

}  // namespace
}  // namespace limn::test
