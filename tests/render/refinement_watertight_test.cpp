#include <cmath>
#include <cstring>

#include "render/capture.h"
#include "render/drawing_test.h"
#include "render/refinement_bodies.h"

namespace limn::test {
namespace {

constexpr int kFinest = 6;
constexpr std::uint32_t kUnrefined = 0xffffffffu;

/// Points that were drawn on the edges and vertices of a mesh, by where they are there: the first to come is kept, all
/// others must have its bits.
class EdgePoints {
 public:
  EdgePoints(const Refiner& object, const std::vector<VertexId>& vertex_source)
      : topology_(object.topology()),
        source_(vertex_source),
        on_edges_(topology_.edge_count() << kFinest),
        at_vertices_(topology_.weld.size()) {}

  void add(std::span<const CapturedVertex> corners) {
    for (const CapturedVertex& corner : corners) {
      if (corner.face == kUnrefined)
        compare(at_vertices_[topology_.weld[source_[corner.place]]], corner.position, 0);
      else
        add_refined(corner);
    }
  }

  std::uint64_t compared() const { return compared_; }
  std::uint64_t mismatches() const { return mismatches_; }
  /// Points within edges that one face has and its neighbour has not.
  std::uint64_t lonely() const {
    std::uint64_t count = 0;
    for (const Point& point : on_edges_)
      count += point.sides == 1 || point.sides == 2 ? 1 : 0;
    return count;
  }

 private:
  struct Point {
    Vec3 position{0.0f};
    std::uint8_t sides = 0;
    bool known = false;
  };

  void compare(Point& point, const Vec3& position, unsigned side) {
    if (!std::exchange(point.known, true)) point.position = position;
    point.sides |= static_cast<std::uint8_t>(1u << side);
    mismatches_ += std::memcmp(&point.position, &position, sizeof(Vec3)) != 0 ? 1 : 0;
    ++compared_;
  }

  void add_refined(const CapturedVertex& corner) {
    const std::uint32_t whole = 1u << corner.level();
    const std::uint32_t weights[3] = {whole - corner.j() - corner.k(), corner.j(), corner.k()};
    for (std::size_t c = 0; c < 3; ++c) {
      if (weights[c] == whole) return compare(at_vertices_[topology_.faces[corner.face][c]], corner.position, 0);
    }
    for (std::size_t c = 0; c < 3; ++c) {
      if (weights[(c + 2) % 3] != 0) continue;
      const EdgeId e = topology_.face_edges[corner.face][c];
      const bool forward = topology_.runs_forward(corner.face, static_cast<int>(c));
      const std::size_t along = weights[forward ? (c + 1) % 3 : c] << (kFinest - static_cast<int>(corner.level()));
      return compare(on_edges_[(std::size_t{e} << kFinest) + along], corner.position,
                     topology_.edges[e].face[0] == corner.face ? 0 : 1);
    }
  }

  const Topology& topology_;
  const std::vector<VertexId>& source_;
  std::vector<Point> on_edges_, at_vertices_;
  std::uint64_t compared_ = 0, mismatches_ = 0;
};

/// Levels that differ from edge to edge, all of [0, most]; `sparse`: few of the larger ones.
std::vector<float> random_levels(std::size_t count, int most, bool sparse, std::uint64_t seed) {
  Random random(seed);
  std::vector<float> levels(count);
  for (float& level : levels)
    level = static_cast<float>(most * std::pow(random.uniform(), sparse ? 6.0 : 1.0));
  return levels;
}

class Watertight : public DrawingTest {
 protected:
  /// Draws a closed mesh with the levels given, or if there are none with those of a view.
  void look_at_edges(const Mesh& mesh, const PatternMethodOptions& options, std::span<const float> levels,
                     const View& view, const std::string& what) {
    const Refiner object = refiner_of(mesh, options);
    auto scene = RefinementScene::create(*context_, object);
    ASSERT_TRUE(scene);
    auto method = PatternMethod::create(*scene, options);
    ASSERT_TRUE(method) << format_error(method.error());
    if (!levels.empty()) method->levels().give(levels);
    ASSERT_TRUE(method->refine(view));
    EdgePoints points(object, scene->vertex_source(0));
    points.add(capture(*method, 3 * method->triangle_count() + 300'000));
    EXPECT_EQ(points.mismatches(), 0u) << what << ", " << name_of(options);
    EXPECT_EQ(points.lonely(), 0u) << what << ", " << name_of(options);
    compared_ += points.compared();
  }

  std::uint64_t compared_ = 0;
};

struct Body {
  const char* what;
  Mesh mesh;
};

std::vector<Body> small_bodies() {
  return {{"knot", body(Shape::kKnot, 400)},
          {"asteroid", body(Shape::kAsteroid, 320)},
          {"cube with hard edges", body(Shape::kCube, 300)},
          {"sphere with a seam", body(Shape::kIcosphere, 320)},
          {"far from the origin", body(Shape::kKnot, 400, 0.7f, Vec3(1000.3f, -2000.7f, 500.1f))},
          {"tiny", body(Shape::kAsteroid, 320, 3.1e-13f)},
          {"huge", body(Shape::kIcosphere, 320, 1.7e11f, Vec3(3e11f, 0, -1e11f))}};
}

std::size_t edge_count(const Mesh& mesh) {
  return build_topology(mesh).edge_count();
}

TEST_F(Watertight, TenMillionPointsOnEdgesAreTheSameBitsFromBothFaces) {
  std::uint64_t seed = 1;
  const Body large[] = {{"knot", body(Shape::kKnot, 28000)},
                        {"asteroid", body(Shape::kAsteroid, 28000)},
                        {"cube with hard edges", body(Shape::kCube, 28000)},
                        {"sphere with a seam", body(Shape::kIcosphere, 28000)}};
  for (PatternMethodOptions options : families_and_blends()) {
    for (const Body& b : large) {
      options.levels.max_level = 2;
      look_at_edges(b.mesh, options, random_levels(edge_count(b.mesh), 2, false, seed++), {}, b.what);
    }
  }
  RecordProperty("compared", std::to_string(compared_));
  EXPECT_GE(compared_, 10'000'000u);
}

TEST_F(Watertight, EdgesOfUpToSixHalvingsAreTheSameBitsFromBothFacesAtAnyScale) {
  std::uint64_t seed = 100;
  for (PatternMethodOptions options : families_and_blends()) {
    for (const Body& b : small_bodies()) {
      options.levels.max_level = kFinest;
      look_at_edges(b.mesh, options, random_levels(edge_count(b.mesh), kFinest, true, seed++), {}, b.what);
    }
  }
  RecordProperty("compared", std::to_string(compared_));
}

TEST_F(Watertight, EdgesOfTheLevelsOfAViewAreTheSameBitsFromBothFaces) {
  for (PatternMethodOptions options : families_and_blends()) {
    for (const Body& b : small_bodies()) {
      options.levels.max_level = 5;
      const Camera camera = fit_camera(face_bounds(b.mesh), 0.7f, 0.4f);
      look_at_edges(b.mesh, options, {}, view_of(camera, 500), b.what);
    }
  }
  RecordProperty("compared", std::to_string(compared_));
}

TEST_F(Watertight, StoredSurfacesAreClosedByTheBitsOfTheirPoints) {
  std::uint64_t seed = 200;
  const auto characteristic = [](const Topology& topology, std::size_t vertices) {
    return static_cast<std::int64_t>(vertices) - static_cast<std::int64_t>(topology.edge_count()) +
           static_cast<std::int64_t>(topology.face_count());
  };
  const auto used = [](const Topology& topology) {
    std::vector<bool> seen(topology.weld.size());
    for (const Triangle& face : topology.faces) {
      for (const VertexId v : face)
        seen[v] = true;
    }
    return static_cast<std::size_t>(std::count(seen.begin(), seen.end(), true));
  };
  for (PatternMethodOptions options : families_and_blends()) {
    for (const Body& b : small_bodies()) {
      options.store = true;
      options.levels.max_level = 4;  // so far from the origin deeper ones put two points in one place
      const Refiner object = refiner_of(b.mesh, options);
      auto scene = RefinementScene::create(*context_, object);
      ASSERT_TRUE(scene);
      auto method = PatternMethod::create(*scene, options);
      ASSERT_TRUE(method) << format_error(method.error());
      method->levels().give(random_levels(object.topology().edge_count(), 4, true, seed++));
      ASSERT_TRUE(method->refine({}));
      const Result<Mesh> stored = method->read();
      ASSERT_TRUE(stored);
      EXPECT_EQ(stored->face_count(), method->triangle_count());
      const Topology topology = build_topology(*stored);
      const auto closed = std::count(topology.edge_class.begin(), topology.edge_class.end(), EdgeClass::kManifold);
      EXPECT_EQ(static_cast<std::size_t>(closed), topology.edge_count()) << b.what << ", " << name_of(options);
      EXPECT_TRUE(topology.degenerate_faces.empty()) << b.what << ", " << name_of(options);
      EXPECT_EQ(characteristic(topology, used(topology)), characteristic(object.topology(), used(object.topology())));
    }
  }
}

TEST_F(Watertight, APointMovedByOneUlpIsNoticed) {
  const PatternMethodOptions options;
  const Refiner object = refiner_of(body(Shape::kAsteroid, 320), options);
  auto scene = RefinementScene::create(*context_, object);
  ASSERT_TRUE(scene);
  auto method = PatternMethod::create(*scene, options);
  ASSERT_TRUE(method);
  ASSERT_TRUE(method->refine({{Vec3(0, 0, 4), false}, 500.0f}));
  std::vector<CapturedVertex> corners = capture(*method, 300'000);
  const auto on_edge = std::find_if(corners.begin(), corners.end(), [](const CapturedVertex& corner) {
    return corner.face != kUnrefined && corner.j() > 0 && corner.k() == 0 && corner.j() < 1u << corner.level();
  });
  ASSERT_NE(on_edge, corners.end());
  on_edge->position.y = std::nextafter(on_edge->position.y, 10.0f);
  EdgePoints moved(object, scene->vertex_source(0));
  moved.add(corners);
  EXPECT_GT(moved.mismatches(), 0u);
  std::erase_if(corners, [face = on_edge->face](const CapturedVertex& corner) { return corner.face == face; });
  EdgePoints missing(object, scene->vertex_source(0));
  missing.add(corners);
  EXPECT_GT(missing.lonely(), 0u);
}

}  // namespace
}  // namespace limn::test
