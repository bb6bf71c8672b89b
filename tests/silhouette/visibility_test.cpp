#include "limn/silhouette/visible/visibility.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <memory>
#include <optional>

#include "limn/base/parallel.h"
#include "limn/base/random.h"
#include "limn/mesh/normals.h"
#include "limn/mesh/shapes.h"
#include "limn/silhouette/brute.h"
#include "limn/silhouette/visible/outer_outline.h"
#include "limn/silhouette/visible/visible_lines.h"

#include "support/stable.h"

#ifdef LIMN_TEST_EMBREE

namespace limn {
namespace {

constexpr float kPi = 3.14159265f;

/// A mesh and all that is built of it, at one place in memory.
struct Model {
  Mesh mesh;
  Topology topology;
  std::vector<Plane> planes;
  FeatureEdges features;
  std::optional<VisibilityScene> scene;

  explicit Model(Mesh m, float crease_rad = 0.6f)
      : mesh(std::move(m)),
        topology(build_topology(mesh)),
        planes(face_planes(mesh)),
        features(feature_edges(topology, face_normals(mesh), crease_rad)) {
    Result<VisibilityScene> built = VisibilityScene::build(mesh, topology);
    if (built) scene.emplace(std::move(*built));
  }
  Model(const Model&) = delete;

  std::vector<EdgeId> silhouette(const Eye& eye) const {
    std::vector<EdgeId> edges;
    extract_silhouette_brute(topology, planes, eye, edges);
    return edges;
  }
  VisibleLines lines(const Eye& eye, const VisibleLinesOptions& options = {}) const {
    return visible_lines(*scene, planes, eye, silhouette(eye), features, options);
  }
  Polylines outline(const Eye& eye) const { return outer_outline(*scene, planes, eye, silhouette(eye)); }
};

/// The definition: every face but those at the edge is met with the line of sight, in double.
bool hidden_by_definition(const Model& model, const Eye& eye, EdgeId edge, double t, bool behind = false) {
  const Edge& e = model.topology.edges[edge];
  const DVec3 p = DVec3(model.mesh.positions[e.v[0]]) * (1.0 - t) + DVec3(model.mesh.positions[e.v[1]]) * t;
  const DVec3 to_eye = eye.orthographic ? DVec3(eye.at) * face_bounds(model.mesh).diagonal() : DVec3(eye.at) - p;
  const DVec3 way = behind ? -to_eye : to_eye;
  for (const Triangle& face : model.topology.faces) {
    if (std::count(face.begin(), face.end(), e.v[0]) + std::count(face.begin(), face.end(), e.v[1]) > 1) continue;
    const DVec3 a = DVec3(model.mesh.positions[face[0]]) - p, b = DVec3(model.mesh.positions[face[1]]) - p,
                c = DVec3(model.mesh.positions[face[2]]) - p;
    const double u = glm::dot(way, glm::cross(b, c)), v = glm::dot(way, glm::cross(c, a)),
                 w = glm::dot(way, glm::cross(a, b));
    if (!((u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0))) continue;
    const double along = glm::dot((a * u + b * v + c * w) / (u + v + w), way) / glm::dot(way, way);
    if (along > 1e-12 && (behind || eye.orthographic || along < 1.0)) return true;
  }
  return false;
}

/// As above; none where the answer changes within 1e-4 of the model's diagonal along the edge.
std::optional<bool> hidden_around(const Model& model, const Eye& eye, EdgeId edge, double t) {
  const Edge& e = model.topology.edges[edge];
  const double length = glm::length(DVec3(model.mesh.positions[e.v[1]]) - DVec3(model.mesh.positions[e.v[0]]));
  const double share = 1e-4 * face_bounds(model.mesh).diagonal() / length;
  if (!(t - share > 0.0 && t + share < 1.0)) return std::nullopt;
  const bool hidden = hidden_by_definition(model, eye, edge, t);
  for (const double step : {-1.0, 1.0}) {
    if (hidden_by_definition(model, eye, edge, t + step * share) != hidden) return std::nullopt;
  }
  return hidden;
}

struct Tally {
  std::size_t tested = 0, wrong = 0;
};

void compare_with_definition(const Model& model, const Eye& eye, int points, Random& random, Tally& tally) {
  const std::vector<EdgeInterval> intervals = model.lines(eye).intervals;
  if (intervals.empty()) return;
  for (int i = 0; i < points; ++i) {
    const EdgeInterval& interval = intervals[random.below(intervals.size())];
    const double t = random.uniform(interval.begin, interval.end);
    const std::optional<bool> hidden = hidden_around(model, eye, interval.edge, t);
    if (!hidden) continue;
    ++tally.tested;
    tally.wrong += *hidden == interval.visible;
  }
}

Eye eye_around(const Mesh& mesh, Random& random, double radius) {
  const Bounds bounds = face_bounds(mesh);
  return {Vec3(DVec3(bounds.center()) + DVec3(random.direction()) * (radius * bounds.diagonal())), false};
}

Mesh joined(Mesh a, const Mesh& b, const Vec3& move, float scale) {
  const auto offset = static_cast<VertexId>(a.positions.size());
  Mesh both;
  both.positions = std::move(a.positions);
  both.faces = std::move(a.faces);
  for (const Vec3& p : b.positions)
    both.positions.push_back(p * scale + move);
  for (const Triangle& t : b.faces)
    both.faces.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  return both;
}

Mesh shape(Shape kind, std::size_t faces) {
  return *make_shape(kind, {.faces = faces});
}

TEST(Visibility, AgreesWithTheDefinitionAtRandomPointsOfManyMeshesAndViews) {
  Random random(41);
  Tally tally;
  std::vector<Mesh> meshes;
  for (const Shape kind : {Shape::kTorus, Shape::kKnot, Shape::kHoles3, Shape::kAsteroid, Shape::kTerrain})
    meshes.push_back(shape(kind, 1200));
  meshes.push_back(joined(shape(Shape::kAsteroid, 800), shape(Shape::kTorus, 400), Vec3(0.3f, 0.1f, 0), 1.0f));
  for (Mesh& mesh : meshes) {
    const Model model(std::move(mesh));
    for (int view = 0; view < 8; ++view) {
      const Eye eye = view % 3 == 0 ? Eye{random.direction(), true} : eye_around(model.mesh, random, 0.9);
      compare_with_definition(model, eye, 400, random, tally);
    }
  }
  EXPECT_GT(tally.tested, 15000u);
  EXPECT_EQ(tally.wrong, 0u) << "of " << tally.tested;
}

TEST(Visibility, AgreesWithTheDefinitionFromInsideTheMeshesBox) {
  Random random(42);
  Tally tally;
  for (const Shape kind : {Shape::kKnot, Shape::kTorus, Shape::kTerrain}) {
    const Model model(shape(kind, 1000));
    for (int view = 0; view < 8; ++view)
      compare_with_definition(model, eye_around(model.mesh, random, 0.2), 300, random, tally);
  }
  EXPECT_GT(tally.tested, 4000u);
  EXPECT_EQ(tally.wrong, 0u) << "of " << tally.tested;
}

TEST(Visibility, AgreesWithTheDefinitionOnAwkwardMeshes) {
  Random random(43);
  Tally tally;
  for (test::StableMesh& item : test::awkward_meshes()) {
    const Model model(std::move(item.mesh));
    if (model.mesh.positions.empty()) continue;
    // Facing in float is a coin toss for a point beside such a mesh, and so is what counts as its silhouette.
    const bool parallel_only = item.name == "far from the origin" || item.name == "subnormal coordinates";
    for (int view = 0; view < 6; ++view) {
      const bool parallel = parallel_only || view % 2 == 0;
      const Eye eye = parallel ? Eye{random.direction(), true} : eye_around(model.mesh, random, 1.1);
      Tally here;
      compare_with_definition(model, eye, 60, random, here);
      EXPECT_EQ(here.wrong, 0u) << item.name << " of " << here.tested;
      tally.tested += here.tested;
    }
  }
  EXPECT_GT(tally.tested, 5000u);
}

TEST(Visibility, OfACubeHidesThreeOfItsTwelveEdges) {
  const Model model(shape(Shape::kCube, 12));
  const Eye eye{Vec3(3, 4, 5), false};
  const VisibleLines lines = model.lines(eye);
  ASSERT_EQ(lines.intervals.size(), 12u);
  std::size_t hidden = 0, silhouettes = 0;
  for (const EdgeInterval& interval : lines.intervals) {
    EXPECT_EQ(interval.begin, 0.0f);
    EXPECT_EQ(interval.end, 1.0f);
    hidden += !interval.visible;
    silhouettes += interval.line_class == LineClass::kSilhouette;
  }
  EXPECT_EQ(hidden, 3u);
  EXPECT_EQ(silhouettes, 6u);
  const Polylines outline = model.outline(eye);
  ASSERT_EQ(outline.lines.size(), 1u);
  EXPECT_TRUE(outline.lines[0].closed);
  EXPECT_EQ(outline.points.size(), 6u);
}

TEST(Visibility, OfASphereBehindAnotherEndsWhereTheirContoursCross) {
  // Radius 1 at the origin, radius 1/2 behind it and half covered; seen along z.
  const Model model(joined(shape(Shape::kIcosphere, 20480), shape(Shape::kIcosphere, 20480), Vec3(1, 0, -3), 0.5f));
  const Eye eye{Vec3(0, 0, 1), true};
  const VisibleLines lines = model.lines(eye);
  double visible = 0, hidden = 0;
  for (const Polyline& line : lines.polylines.lines) {
    for (std::uint32_t i = line.begin; i + 1 < line.end; ++i) {
      const Vec3 p = lines.polylines.points[i] - Vec3(1, 0, -3), q = lines.polylines.points[i + 1] - Vec3(1, 0, -3);
      const double angle = std::remainder(std::atan2(q.y, q.x) - std::atan2(p.y, p.x), 2.0 * kPi);
      if (lines.polylines.points[i].z < -2) (line.visible ? visible : hidden) += std::abs(angle);
    }
  }
  // Where x² + y² = 1 and (x − 1)² + y² = 1/4: x = 7/8, at cos = -1/4 about the small circle's centre.
  const double hidden_share = std::acos(0.25) / kPi;
  EXPECT_NEAR(hidden / (hidden + visible), hidden_share, 0.002);
  EXPECT_EQ(lines.polylines.lines.size(), 3u);  // the front circle, closed; the other, visible and hidden
  const Polylines outline = model.outline(eye);
  ASSERT_EQ(outline.lines.size(), 1u);
  EXPECT_TRUE(outline.lines[0].closed);
}

TEST(Visibility, OfATorusSeenFromTheSideTurnsAtFourCusps) {
  const Model model(shape(Shape::kTorus, 20000));
  Bounds bounds = face_bounds(model.mesh);
  const Vec3 size = bounds.high - bounds.low;
  const Vec3 axis = size.x < size.y && size.x < size.z ? Vec3(1, 0, 0)
                    : size.y < size.z                  ? Vec3(0, 1, 0)
                                                       : Vec3(0, 0, 1);
  const Vec3 side = axis.x > 0 ? Vec3(0, 1, 0) : Vec3(1, 0, 0);
  const Eye eye{glm::normalize(side + 0.35f * axis), true};
  const VisibleLines lines = model.lines(eye);
  std::size_t visible = 0, hidden = 0;
  for (const Polyline& line : lines.polylines.lines)
    (line.visible ? visible : hidden) += line.end - line.begin > 8;
  // The outline of the ring, and of the hole the near rim: that one hides the far rim's ends and two swallowtails.
  EXPECT_GE(visible, 2u);
  EXPECT_GE(hidden, 1u);
  Random random(44);
  Tally tally;
  compare_with_definition(model, eye, 300, random, tally);
  EXPECT_EQ(tally.wrong, 0u) << "of " << tally.tested;
}

TEST(Visibility, OfNestedShellsHidesTheInnerOne) {
  const Model model(joined(shape(Shape::kIcosphere, 1280), shape(Shape::kIcosphere, 1280), Vec3(0), 0.5f));
  const VisibleLines lines = model.lines({Vec3(0, 1, 4), false}, {.outer = true});
  ASSERT_EQ(lines.polylines.lines.size(), 2u);
  EXPECT_NE(lines.polylines.lines[0].visible, lines.polylines.lines[1].visible);
  for (const Polyline& line : lines.polylines.lines) {
    EXPECT_TRUE(line.closed);
    EXPECT_EQ(line.outer, line.visible);
  }
}

TEST(Visibility, EndsWhereALineRunsThroughAFace) {
  // A fin that pierces a plate: its boundary dips below, seen from above.
  Mesh mesh;
  mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0.1f, 0.1f, 1}, {0.3f, 0.2f, -1}, {0.2f, 0.6f, 1}};
  mesh.faces = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}};
  const Model model(std::move(mesh));
  std::size_t cut = 0;
  for (const EdgeInterval& interval : model.lines({Vec3(0.05f, 0.02f, 1), true}).intervals)
    cut += interval.begin > 0.4f && interval.begin < 0.6f;
  EXPECT_EQ(cut, 2u);
}

TEST(Visibility, MarksAsOuterWhatTheBackgroundIsSeenPast) {
  Random random(45);
  std::size_t tested = 0, wrong = 0;
  for (const Shape kind : {Shape::kTorus, Shape::kKnot, Shape::kHoles3, Shape::kAsteroid, Shape::kTerrain}) {
    const Model model(shape(kind, 1200));
    for (int view = 0; view < 5; ++view) {
      const Eye eye = view % 2 == 0 ? Eye{random.direction(), true} : eye_around(model.mesh, random, 1.0);
      const VisibleLines lines = model.lines(eye, {.outer = true});
      for (int i = 0; i < 200; ++i) {
        const EdgeInterval& interval = lines.intervals[random.below(lines.intervals.size())];
        if (interval.line_class == LineClass::kCrease) continue;
        const double t = random.uniform(interval.begin, interval.end);
        const double near = std::min(t - interval.begin, interval.end - t);
        if (near < 0.02) continue;
        const bool expected = !hidden_by_definition(model, eye, interval.edge, t) &&
                              !hidden_by_definition(model, eye, interval.edge, t, true);
        ++tested;
        wrong += expected != interval.outer;
      }
    }
  }
  EXPECT_GT(tested, 2000u);
  EXPECT_EQ(wrong, 0u) << "of " << tested;
}

TEST(OuterOutline, IsClosedLoopsOfClosedMeshes) {
  Random random(46);
  for (const Shape kind : {Shape::kIcosphere, Shape::kTorus, Shape::kKnot, Shape::kHoles3, Shape::kAsteroid}) {
    const Model model(shape(kind, 3000));
    for (int view = 0; view < 6; ++view) {
      const Eye eye = view % 2 == 0 ? Eye{random.direction(), true} : eye_around(model.mesh, random, 1.2);
      const Polylines outline = model.outline(eye);
      EXPECT_GE(outline.lines.size(), 1u);
      std::size_t open = 0;
      for (const Polyline& line : outline.lines)
        open += !line.closed;
      EXPECT_EQ(open, 0u) << static_cast<int>(kind) << " view " << view << " of " << outline.lines.size();
    }
  }
}

void expect_well_joined(const Polylines& polylines) {
  ASSERT_EQ(polylines.points.size(), polylines.edges.size());
  for (const Polyline& line : polylines.lines) {
    ASSERT_GE(line.end - line.begin, 2u);
    for (std::uint32_t i = line.begin; i + 1 < line.end; ++i) {
      EXPECT_NE(polylines.points[i], polylines.points[i + 1]);
      EXPECT_NE(polylines.edges[i], kInvalidId);
    }
    EXPECT_EQ(polylines.edges[line.end - 1] == kInvalidId, !line.closed);
    if (line.closed) {
      EXPECT_NE(polylines.points[line.begin], polylines.points[line.end - 1]);
    }
  }
}

TEST(VisibleLines, AreWellJoinedAndTheirIntervalsCoverEveryEdge) {
  Random random(47);
  for (test::StableMesh& item : test::awkward_meshes()) {
    const Model model(std::move(item.mesh), 0.2f);
    for (int view = 0; view < 6; ++view) {
      const Eye eye = view % 2 == 0 || model.mesh.positions.empty() ? Eye{random.direction(), true}
                                                                    : eye_around(model.mesh, random, 0.8);
      const VisibleLines lines = model.lines(eye, {.outer = view % 3 == 0});
      expect_well_joined(lines.polylines);
      EdgeId edge = kInvalidId;
      float at = 1.0f;
      for (const EdgeInterval& interval : lines.intervals) {
        if (interval.edge != edge) {
          EXPECT_EQ(at, 1.0f) << item.name;
          at = 0.0f;
        }
        edge = interval.edge;
        EXPECT_EQ(interval.begin, at) << item.name;
        EXPECT_LE(interval.begin, interval.end);
        at = interval.end;
      }
      EXPECT_EQ(at, 1.0f) << item.name;
    }
  }
}

TEST(VisibleLines, AreTheSameForAnyNumberOfThreads) {
  const Model model(shape(Shape::kAsteroid, 20000));
  const Eye eye{Vec3(1.5f, 2, 1), false};
  const auto run = [&](int threads) {
    const ThreadLimit limit(threads);
    return model.lines(eye, {.outer = true});
  };
  const VisibleLines one = run(1), two = run(2);
  ASSERT_EQ(one.polylines.points, two.polylines.points);
  ASSERT_EQ(one.polylines.edges, two.polylines.edges);
  ASSERT_EQ(one.intervals.size(), two.intervals.size());
  for (std::size_t i = 0; i < one.intervals.size(); ++i) {
    EXPECT_EQ(one.intervals[i].begin, two.intervals[i].begin);
    EXPECT_EQ(one.intervals[i].visible, two.intervals[i].visible);
    EXPECT_EQ(one.intervals[i].outer, two.intervals[i].outer);
  }
}

TEST(VisibleLines, WithoutHiddenOnesKeepTheVisibleOnes) {
  const Model model(shape(Shape::kKnot, 4000), kPi);
  const Eye eye{Vec3(3, 2, 1), false};
  const VisibleLines all = model.lines(eye), visible = model.lines(eye, {.hidden = false});
  const auto count = [](const VisibleLines& lines, bool seen) {
    return std::count_if(lines.polylines.lines.begin(), lines.polylines.lines.end(),
                         [seen](const Polyline& line) { return line.visible == seen; });
  };
  EXPECT_EQ(count(all, true), count(visible, true));
  EXPECT_GT(count(all, false), 0);
  EXPECT_EQ(count(visible, false), 0);
  EXPECT_EQ(all.intervals.size(), visible.intervals.size());
}

}  // namespace
}  // namespace limn

#else

namespace limn {
namespace {

TEST(Visibility, SaysWhatIsMissingWithoutEmbree) {
  const Mesh mesh = *make_shape(Shape::kCube, {});
  const Topology topology = build_topology(mesh);
  const Result<VisibilityScene> scene = VisibilityScene::build(mesh, topology);
  ASSERT_FALSE(scene);
  EXPECT_EQ(scene.error().code, ErrorCode::kUnsuitable);
  EXPECT_NE(scene.error().message.find("Embree"), std::string::npos);
}

}  // namespace
}  // namespace limn

#endif
