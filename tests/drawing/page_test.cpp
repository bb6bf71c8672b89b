// Pages hold clean strokes: projected right, cut right, joined, nothing twice, nothing left over.
#include "limn/drawing/page.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <map>
#include <string>

#include "limn/base/random.h"
#include "limn/mesh/shapes.h"

#include "drawing/lines.h"
#include "support/stable.h"

namespace limn::test {
namespace {

using DVec2 = glm::dvec2;

Page must_lay_out(const Polylines& lines, const Camera& camera, const PageOptions& options = {}) {
  Result<Page> page = lay_out(lines, camera, options);
  EXPECT_TRUE(page) << format_error(page.error());
  return page ? std::move(*page) : Page{};
}

struct Segment {
  DVec2 a;
  DVec2 b;
  Layer layer;
};

std::vector<Segment> segments_of(const Page& page) {
  std::vector<Segment> segments;
  for (const Stroke& stroke : page.strokes) {
    for (std::uint32_t i = stroke.begin; i + 1 < stroke.end; ++i)
      segments.push_back({page.points[i], page.points[i + 1], stroke.layer});
    if (stroke.closed) segments.push_back({page.points[stroke.end - 1], page.points[stroke.begin], stroke.layer});
  }
  return segments;
}

double distance(const DVec2& p, const Segment& s) {
  const DVec2 along = s.b - s.a;
  const double square = glm::dot(along, along);
  const double at = square > 0.0 ? std::clamp(glm::dot(p - s.a, along) / square, 0.0, 1.0) : 0.0;
  return glm::distance(p, s.a + along * at);
}

double distance(const DVec2& p, const std::vector<Segment>& segments) {
  double nearest = HUGE_VAL;
  for (const Segment& segment : segments)
    nearest = std::min(nearest, distance(p, segment));
  return nearest;
}

double ink_mm(const Page& page) {
  double length = 0.0;
  for (const Segment& segment : segments_of(page))
    length += glm::distance(segment.a, segment.b);
  return length;
}

void expect_clean(const Page& page, const std::string& name) {
  for (const DVec2& point : page.points) {
    ASSERT_TRUE(std::isfinite(point.x) && std::isfinite(point.y)) << name;
    EXPECT_TRUE(point.x >= -1e-9 && point.x <= page.width_mm + 1e-9) << name;
    EXPECT_TRUE(point.y >= -1e-9 && point.y <= page.height_mm + 1e-9) << name;
  }
  std::uint32_t next = 0;
  for (const Stroke& stroke : page.strokes) {
    EXPECT_EQ(stroke.begin, next) << name;
    EXPECT_GE(stroke.end, stroke.begin + (stroke.closed ? 3 : 2)) << name;
    next = stroke.end;
  }
  EXPECT_EQ(next, page.points.size()) << name;
  for (const Segment& segment : segments_of(page))
    EXPECT_GT(glm::distance(segment.a, segment.b), 0.0) << name;
}

/// No two ends of one layer meet alone: they would have been joined.
void expect_joined(const Page& page, const std::string& name) {
  std::map<std::tuple<Layer, double, double>, int> ends;
  for (const Stroke& stroke : page.strokes) {
    if (stroke.closed) continue;
    for (const DVec2& end : {page.points[stroke.begin], page.points[stroke.end - 1]})
      ++ends[{stroke.layer, end.x, end.y}];
  }
  for (const auto& [end, count] : ends)
    EXPECT_NE(count, 2) << name << " at " << std::get<1>(end) << ", " << std::get<2>(end);
}

TEST(Page, PutsAModelAtItsScaleOntoTheMiddleOfThePaper) {
  Polylines lines;
  add_line(lines, {{0, 0, 0}, {30, 0, 0}, {30, 20, 5}});
  PageOptions options = life_size();
  options.margin_mm = 5;
  const Page page = must_lay_out(lines, from_above(), options);
  EXPECT_EQ(page.width_mm, 40);
  EXPECT_EQ(page.height_mm, 30);
  EXPECT_EQ(page.mm_per_unit, 1);
  ASSERT_EQ(page.points.size(), 3u);
  EXPECT_EQ(page.points[0], DVec2(5, 5));
  EXPECT_EQ(page.points[1], DVec2(35, 5));
  EXPECT_EQ(page.points[2], DVec2(35, 25));
  options.width_mm = 100;
  options.mm_per_unit = 0.5;
  EXPECT_EQ(must_lay_out(lines, from_above(), options).points[0], DVec2(42.5, 5));
}

TEST(Page, FillsThePaperInsideItsMargins) {
  const Mesh mesh = *make_shape(Shape::kKnot, {.faces = 2000});
  for (const bool orthographic : {false, true}) {
    const Camera camera = fit_camera(mesh.positions, view_direction(0.5f, 0.3f), {.orthographic = orthographic});
    PageOptions options;
    options.width_mm = 150;
    options.height_mm = 90;
    options.margin_mm = 8;
    const Page page = must_lay_out(outline_edges(mesh, camera), camera, options);
    expect_clean(page, "knot");
    DVec2 low(1e9), high(-1e9);
    for (const DVec2& point : page.points) {
      low = glm::min(low, point);
      high = glm::max(high, point);
    }
    EXPECT_NEAR(low.y, 8, 0.01);
    EXPECT_NEAR(high.y, 82, 0.01);
    EXPECT_NEAR(low.x + high.x, 150, 0.01);
    EXPECT_EQ(page.mm_per_unit > 0, orthographic);
  }
}

TEST(Page, ProjectsAsTheCameraDoes) {
  Camera camera;
  camera.eye = {3, 2, 5};
  camera.target = {0.5f, 0, 0};
  camera.fov_rad = 0.7f;
  const Mat4 clip = projection_matrix(camera, 1.0f) * view_matrix(camera);
  Random random(3);
  Polylines lines;
  std::vector<Segment> expected;
  PageOptions options;
  options.frame = Frame::kCamera;
  options.width_mm = 120;
  for (int i = 0; i < 200; ++i) {
    Vec3 ends[2];
    DVec2 seen[2];
    for (int k = 0; k < 2; ++k) {
      ends[k] = {float(random.uniform() - 0.5), float(random.uniform() - 0.5), float(random.uniform() - 0.5)};
      const Vec4 p = clip * Vec4(ends[k], 1);
      seen[k] = DVec2(60 + 50 * double(p.x / p.w), 60 + 50 * double(p.y / p.w));
    }
    add_line(lines, {ends[0], ends[1]});
    expected.push_back({seen[0], seen[1], 0});
  }
  const Page page = must_lay_out(lines, camera, options);
  EXPECT_EQ(page.height_mm, 120);
  for (const DVec2& point : page.points)
    EXPECT_LT(distance(point, expected), 0.01);
}

TEST(Page, CutsAtTheBordersOfTheCamerasPicture) {
  Camera camera = from_above();
  camera.ortho_height = 2;
  Polylines lines;
  add_line(lines, {{-5, 0.5f, 0}, {5, 0.5f, 0}});
  add_line(lines, {{0, 0, 0}, {0, 3, 0}, {0.5f, 3, 0}, {0.5f, 0, 0}});
  add_line(lines, {{3, 3, 0}, {4, 5, 0}});
  PageOptions options;
  options.frame = Frame::kCamera;
  options.width_mm = 100;
  options.margin_mm = 0;
  const Page page = must_lay_out(lines, camera, options);
  expect_clean(page, "frame");
  ASSERT_EQ(page.strokes.size(), 3u);
  EXPECT_EQ(page.points[0], DVec2(0, 75));
  EXPECT_EQ(page.points[1], DVec2(100, 75));
  EXPECT_EQ(page.points[2], DVec2(50, 50));
  EXPECT_EQ(page.points[3], DVec2(50, 100));
  EXPECT_EQ(page.points[4], DVec2(75, 100));
}

TEST(Page, CutsWhatLiesBehindTheEyeOrFarToTheSide) {
  Camera camera;
  camera.eye = {0, 0, 0};
  camera.target = {0, 0, -1};
  camera.near_distance = 0.5f;
  Polylines lines;
  add_line(lines, {{0, 0, -10}, {0, 0.25f, 10}});
  add_line(lines, {{0, 0, 5}, {1, 0, 5}});
  add_line(lines, {{-1, 0, -1}, {1000, 0, -1}});
  PageOptions options;
  options.margin_mm = 0;
  options.width_mm = 100;
  const Page page = must_lay_out(lines, camera, options);
  expect_clean(page, "behind");
  EXPECT_EQ(page.strokes.size(), 2u);
  // From x/z = -1 to tan 80°.
  EXPECT_NEAR(page.points.back().x - page.points[page.points.size() - 2].x, 100, 0.001);
}

TEST(Page, AClosedLineThatIsCutBecomesItsParts) {
  Camera camera = from_above();
  camera.ortho_height = 2;
  Polylines lines;
  add_line(lines, {{0, 0, 0}, {3, 0, 0}, {3, 0.5f, 0}, {0, 0.5f, 0}}, LineClass::kSilhouette, true, true);
  add_line(lines, {{-0.5f, -0.5f, 0}, {-0.25f, -0.5f, 0}, {-0.25f, -0.25f, 0}}, LineClass::kSilhouette, true, true);
  PageOptions options;
  options.frame = Frame::kCamera;
  options.width_mm = 100;
  options.margin_mm = 0;
  const Page page = must_lay_out(lines, camera, options);
  ASSERT_EQ(page.strokes.size(), 2u);
  EXPECT_FALSE(page.strokes[0].closed);
  EXPECT_EQ(page.strokes[0].end - page.strokes[0].begin, 4u);
  EXPECT_TRUE(page.strokes[1].closed);
}

TEST(Page, JoinsLooseEdgesIntoLoops) {
  const Mesh mesh = *make_shape(Shape::kIcosphere, {.faces = 5000});
  const Camera camera = fit_camera(mesh.positions, view_direction(0.4f, 0.2f));
  const Page page = must_lay_out(outline_edges(mesh, camera), camera);
  ASSERT_EQ(page.strokes.size(), 1u);
  EXPECT_TRUE(page.strokes[0].closed);
  EXPECT_NEAR(page.width_mm, 200, 1e-9);
  EXPECT_NEAR(page.height_mm, 200, 1.0);
}

TEST(Page, JoinsAcrossReversedEnds) {
  Polylines lines;
  add_line(lines, {{10, 0, 0}, {0, 0, 0}});
  add_line(lines, {{10, 0, 0}, {10, 10, 0}});
  add_line(lines, {{0, 20, 0}, {10, 10, 0}});
  const Page page = must_lay_out(lines, from_above(), life_size());
  ASSERT_EQ(page.strokes.size(), 1u);
  EXPECT_EQ(page.points.size(), 4u);
}

TEST(Page, DoesNotJoinAtBranchesOrAcrossLayers) {
  Polylines lines;
  for (const Vec3& end : {Vec3(10, 0, 0), Vec3(0, 10, 0), Vec3(-10, -10, 0)})
    add_line(lines, {{0, 0, 0}, end});
  add_line(lines, {{10, 0, 0}, {20, 0, 0}}, LineClass::kCrease);
  add_line(lines, {{10, 0, 0}, {20, 5, 0}}, LineClass::kSilhouette, false);
  EXPECT_EQ(must_lay_out(lines, from_above(), life_size()).strokes.size(), 5u);
}

TEST(Page, GoesOnThroughABranchAsTheLineDid) {
  Polylines lines;
  add_line(lines, {{-10, 0, 0}, {0, 0, 0}, {10, 5, 0}});
  add_line(lines, {{0, -10, 0}, {0, 0, 0}, {3, 10, 0}});
  const Page page = must_lay_out(lines, from_above(), life_size());
  EXPECT_EQ(page.strokes.size(), 2u);
  EXPECT_EQ(page.points.size(), 6u);
}

TEST(Page, LeavesOutCollinearPoints) {
  Polylines lines;
  std::vector<Vec3> points;
  for (int i = 0; i <= 100; ++i)
    points.emplace_back(float(i), 0.0f, float(i % 7));
  for (int i = 1; i <= 100; ++i)
    points.emplace_back(100.0f, float(i), 0.0f);
  add_line(lines, points);
  const Page page = must_lay_out(lines, from_above(), life_size());
  ASSERT_EQ(page.points.size(), 3u);
  EXPECT_EQ(page.points[1], DVec2(100, 0));
}

TEST(Page, LeavesOutCollinearPointsWhereALoopBegins) {
  Polylines lines;
  add_line(lines, {{5, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}, {0, 0, 0}}, LineClass::kSilhouette, true, true);
  const Page page = must_lay_out(lines, from_above(), life_size());
  EXPECT_EQ(page.points.size(), 4u);
  EXPECT_TRUE(page.strokes[0].closed);
}

TEST(Page, KeepsAPointWhereTheLineTurnsBack) {
  Polylines lines;
  add_line(lines, {{0, 0, 0}, {100, 0, 0}, {50, 0.001f, 0}, {50, 40, 0}});
  const Page page = must_lay_out(lines, from_above(), life_size());
  double farthest = 0.0;
  for (const DVec2& point : page.points)
    farthest = std::max(farthest, point.x);
  EXPECT_EQ(farthest, 100.0);
  EXPECT_NEAR(ink_mm(page), 140.0, 0.01) << "the way back is drawn already";
}

TEST(Page, DrawsWhatCoincidesOnce) {
  Polylines lines;
  add_line(lines, {{0, 0, 0}, {10, 0, 0}}, LineClass::kCrease);
  add_line(lines, {{10, 0, 5}, {0, 0, 5}});
  add_line(lines, {{0, 0, -5}, {10, 0, -5}}, LineClass::kSilhouette, false);
  add_line(lines, {{0, 0, 1}, {10, 0, 1}});
  const Page page = must_lay_out(lines, from_above(), life_size());
  ASSERT_EQ(page.strokes.size(), 1u);
  EXPECT_EQ(page.strokes[0].layer, layer_of(LineClass::kSilhouette, true));
}

TEST(Page, DrawsPartialOverlapsOnce) {
  Polylines lines;
  add_line(lines, {{0, 0, 0}, {10, 0, 0}});
  add_line(lines, {{4, 0, 3}, {20, 0, 3}, {20, 8, 3}});
  add_line(lines, {{-6, 0, 3}, {30, 0, 3}}, LineClass::kSilhouette, false);
  const Page page = must_lay_out(lines, from_above(), life_size());
  EXPECT_NEAR(ink_mm(page), 36 + 8, 1e-6);
  ASSERT_EQ(page.strokes.size(), 3u);
  EXPECT_EQ(page.strokes[0].end - page.strokes[0].begin, 3u) << "joined where the overlap ended";
  EXPECT_EQ(page.strokes[1].layer, layer_of(LineClass::kSilhouette, false));
}

TEST(Page, DrawsTheCubeSeenAlongAnAxisAsASquare) {
  const Mesh mesh = *make_shape(Shape::kCube, {.faces = 12});
  Camera camera = fit_camera(mesh.positions, {0, 0, 1}, {.orthographic = true});
  Polylines lines = outline_edges(mesh, camera);
  const Topology topology = build_topology(mesh);
  for (EdgeId edge = 0; edge < topology.edge_count(); ++edge) {
    const Vec3 a = mesh.positions[topology.edges[edge].v[0]];
    const Vec3 b = mesh.positions[topology.edges[edge].v[1]];
    const int differing = int(a.x != b.x) + int(a.y != b.y) + int(a.z != b.z);
    if (differing == 1) add_edges(lines, mesh, topology, {edge}, LineClass::kCrease, false);
  }
  const Page page = must_lay_out(lines, camera);
  ASSERT_EQ(page.strokes.size(), 1u);
  EXPECT_TRUE(page.strokes[0].closed);
  EXPECT_EQ(page.points.size(), 4u);
  EXPECT_NEAR(ink_mm(page), 4 * 180, 0.01);
}

TEST(Page, CrossingsAreNotOverlaps) {
  Polylines lines;
  Random random(11);
  double ink = 0.0;
  for (int i = 0; i < 300; ++i) {
    const Vec3 a(float(random.uniform()) * 100, float(random.uniform()) * 100, 0);
    const Vec3 b(float(random.uniform()) * 100, float(random.uniform()) * 100, 0);
    add_line(lines, {a, b});
    ink += double(glm::distance(a, b));
  }
  const Page page = must_lay_out(lines, from_above(), life_size());
  EXPECT_NEAR(ink_mm(page), ink, 0.5);
}

TEST(Page, StaysWithinItsTolerancesOfTheLines) {
  const Mesh mesh = *make_shape(Shape::kAsteroid, {.faces = 3000});
  const Camera camera = fit_camera(mesh.positions, view_direction(1.0f, 0.1f), {.orthographic = true});
  const Polylines lines = outline_edges(mesh, camera);
  PageOptions fine;
  fine.tolerance_mm = 0.001;
  const std::vector<Segment> exact = segments_of(must_lay_out(lines, camera, fine));
  for (const double tolerance : {0.002, 0.05, 0.5}) {
    PageOptions options;
    options.tolerance_mm = tolerance;
    const Page page = must_lay_out(lines, camera, options);
    expect_clean(page, "asteroid");
    expect_joined(page, "asteroid");
    const std::vector<Segment> drawn = segments_of(page);
    EXPECT_LE(drawn.size(), exact.size());
    for (const Segment& segment : exact)
      EXPECT_LT(distance(0.5 * (segment.a + segment.b), drawn), 4 * tolerance + 0.003) << tolerance;
    for (const DVec2& point : page.points)
      EXPECT_LT(distance(point, exact), 4 * tolerance + 0.003) << tolerance;
  }
}

TEST(Page, OfEveryAwkwardMeshIsCleanFromEverywhere) {
  for (const StableMesh& stable : awkward_meshes()) {
    if (stable.mesh.faces.empty()) continue;
    std::vector<Vec3> used;
    for (const Triangle& face : stable.mesh.faces) {
      for (const VertexId v : face)
        used.push_back(stable.mesh.positions[v]);
    }
    for (const bool orthographic : {false, true}) {
      for (const Vec3& direction : {Vec3(0, 0, 1), Vec3(0, 1, 0), view_direction(0.6f, 0.4f)}) {
        const Camera camera = fit_camera(used, direction, {.orthographic = orthographic});
        const Result<Page> page = lay_out(outline_edges(stable.mesh, camera), camera);
        if (!page) {
          EXPECT_EQ(page.error().code, ErrorCode::kUnsuitable) << stable.name;
          continue;
        }
        expect_clean(*page, stable.name);
        expect_joined(*page, stable.name);
      }
    }
  }
}

TEST(Page, OfAMeshFarFromTheOriginOrOfAnySizeIsTheSame) {
  const Mesh plain = *make_shape(Shape::kTorus, {.faces = 2000});
  const auto drawn = [](const Mesh& mesh) {
    const Camera camera = fit_camera(mesh.positions, view_direction(0.4f, 0.5f));
    return must_lay_out(outline_edges(mesh, camera), camera);
  };
  const Page expected = drawn(plain);
  for (const float scale : {1e-18f, 1e-6f, 1e6f, 1e15f}) {
    Mesh mesh = plain;
    for (Vec3& p : mesh.positions)
      p *= scale;
    const Page page = drawn(mesh);
    expect_clean(page, std::to_string(scale));
    EXPECT_NEAR(page.height_mm, expected.height_mm, 0.1) << scale;
    EXPECT_NEAR(ink_mm(page), ink_mm(expected), 0.03 * ink_mm(expected)) << scale;
  }
  Mesh far = plain;
  for (Vec3& p : far.positions)
    p = p * 1000.0f + Vec3(1e6f, -1e6f, 1e6f);
  const Page page = drawn(far);
  expect_clean(page, "far");
  EXPECT_NEAR(page.height_mm, expected.height_mm, 0.5);
}

TEST(Page, SeenFromInsideTheMeshIsFinite) {
  const Mesh mesh = *make_shape(Shape::kKnot, {.faces = 4000});
  Camera camera;
  camera.eye = bounds_of(mesh.positions).center();
  camera.target = mesh.positions[0];
  camera.near_distance = 1e-4f;
  for (const Frame frame : {Frame::kContent, Frame::kCamera}) {
    PageOptions options;
    options.frame = frame;
    const Page page = must_lay_out(outline_edges(mesh, camera), camera, options);
    expect_clean(page, "inside");
    EXPECT_FALSE(page.strokes.empty());
  }
}

TEST(Page, WithoutLinesIsBlank) {
  const Page page = must_lay_out({}, Camera{});
  EXPECT_EQ(page.strokes.size(), 0u);
  EXPECT_EQ(page.width_mm, 200);
  EXPECT_EQ(page.height_mm, 20);
}

TEST(Page, OfOnePointOrOneUprightLineHasASize) {
  Polylines point, upright;
  add_line(point, {{1, 2, 3}, {1, 2, 7}});
  add_line(upright, {{1, 2, 3}, {1, 4, 3}});
  const Page blank = must_lay_out(point, from_above());
  EXPECT_EQ(blank.strokes.size(), 0u);
  EXPECT_EQ(blank.width_mm, 200);
  const Page page = must_lay_out(upright, from_above());
  EXPECT_EQ(page.height_mm, 4 * 180 + 20);
  EXPECT_EQ(page.points[0].x, 100);
}

TEST(Page, RefusesWhatCannotBe) {
  Polylines lines;
  add_line(lines, {{0, 0, 0}, {300, 0, 0}});
  const auto code = [&](const PageOptions& options, const Camera& camera) {
    const Result<Page> page = lay_out(lines, camera, options);
    EXPECT_FALSE(page);
    return page ? std::string() : page.error().message;
  };
  PageOptions options;
  options.mm_per_unit = 1;
  EXPECT_NE(code(options, Camera{}).find("perspective"), std::string::npos);
  EXPECT_NE(code(options, from_above()).find("300.0 x 0.0 mm"), std::string::npos);
  options.width_mm = 0;
  options.mm_per_unit = 1e9;
  EXPECT_NE(code(options, from_above()).find("100 m"), std::string::npos);
  for (auto change : {+[](PageOptions& o) { o.width_mm = 0; }, +[](PageOptions& o) { o.width_mm = NAN; },
                      +[](PageOptions& o) { o.height_mm = -1; }, +[](PageOptions& o) { o.margin_mm = 100; },
                      +[](PageOptions& o) { o.margin_mm = -1; }, +[](PageOptions& o) { o.tolerance_mm = 0; },
                      +[](PageOptions& o) { o.tolerance_mm = NAN; }, +[](PageOptions& o) { o.mm_per_unit = -1; }}) {
    PageOptions bad;
    change(bad);
    EXPECT_NE(code(bad, from_above()), "");
  }
}

TEST(Page, RefusesCoordinatesThatAreNotFinite) {
  Polylines lines;
  add_line(lines, {{0, 0, 0}, {NAN, 0, 0}});
  add_line(lines, {{0, 0, 0}, {INFINITY, 1, 0}});
  const Result<Page> page = lay_out(lines, from_above());
  ASSERT_FALSE(page);
  EXPECT_EQ(page.error().code, ErrorCode::kUnsuitable);
}

}  // namespace
}  // namespace limn::test
