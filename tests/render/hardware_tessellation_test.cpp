#include "limn/render/refinement/hardware_tessellation.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <tuple>

#include "limn/mesh/shapes.h"
#include "limn/render/refinement/patterns.h"

#include "render/capture.h"
#include "render/drawing_test.h"

namespace limn::test {
namespace {

constexpr TessellationSpacing kSpacings[] = {TessellationSpacing::kEqual, TessellationSpacing::kFractionalOdd,
                                             TessellationSpacing::kFractionalEven};
constexpr View kView{{Vec3(1.2f, 0.7f, 3.0f), false}, 1000.0f};

Refiner refiner(Shape kind, std::size_t faces) {
  auto mesh = make_shape(kind, {.faces = faces});
  EXPECT_TRUE(mesh);
  auto made = Refiner::create(std::move(*mesh));
  EXPECT_TRUE(made);
  return std::move(*made);
}

using Bits = std::array<std::uint32_t, 3>;
Bits bits_of(const Vec3& p) {
  return {std::bit_cast<std::uint32_t>(p.x), std::bit_cast<std::uint32_t>(p.y), std::bit_cast<std::uint32_t>(p.z)};
}

class HardwareTessellation : public DrawingTest {
 protected:
  /// What is drawn for the view, checked against the count.
  std::vector<CapturedVertex> captured(RefinementScene& scene, const HardwareTessellationOptions& options) {
    auto method = HardwareTessellationMethod::create(scene, options);
    EXPECT_TRUE(method) << format_error(method.error());
    EXPECT_TRUE(method->refine(kView));
    const std::uint64_t expected = method->triangle_count();
    std::vector<CapturedVertex> seen = capture(*method, 3 * expected + 30000);
    EXPECT_EQ(seen.size(), 3 * expected) << "spacing " << static_cast<int>(options.spacing);
    return seen;
  }
};

TEST_F(HardwareTessellation, HasNoCracksInAnySpacing) {
  for (const Shape kind : {Shape::kKnot, Shape::kCube, Shape::kIcosphere, Shape::kHoles3}) {
    const Refiner object = refiner(kind, 600);
    auto scene = RefinementScene::create(*context_, object);
    ASSERT_TRUE(scene) << format_error(scene.error());
    for (const TessellationSpacing spacing : kSpacings) {
      std::map<std::pair<Bits, Bits>, int> edges;  // runs one way less runs the other
      const std::vector<CapturedVertex> seen = captured(*scene, {.levels = {.max_level = 4}, .spacing = spacing});
      ASSERT_GT(seen.size(), 3 * object.mesh().face_count());
      for (std::size_t i = 0; i < seen.size(); ++i) {
        const Bits a = bits_of(seen[i].position);
        const Bits b = bits_of(seen[i % 3 == 2 ? i - 2 : i + 1].position);
        edges[std::minmax(a, b)] += a < b ? 1 : -1;
      }
      const auto open = std::count_if(edges.begin(), edges.end(), [](const auto& edge) { return edge.second != 0; });
      EXPECT_EQ(open, 0) << "shape " << static_cast<int>(kind) << " spacing " << static_cast<int>(spacing);
    }
  }
}

TEST_F(HardwareTessellation, PutsPatternsPointsOnEdges) {
  const Refiner object = refiner(Shape::kKnot, 600);
  auto scene = RefinementScene::create(*context_, object);
  ASSERT_TRUE(scene);
  auto patterns = PatternMethod::create(*scene, {.levels = {.max_level = 4}, .family = PatternFamily::kMinimal});
  ASSERT_TRUE(patterns);
  ASSERT_TRUE(patterns->refine(kView));
  std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>, Bits> points;  // face, weights of 2^11
  const auto on_edge = [](std::uint32_t j, std::uint32_t k) { return j == 0 || k == 0 || j + k == 2048; };
  for (const CapturedVertex& v : capture(*patterns, 300000)) {
    const std::uint32_t j = v.j() << (11 - v.level()), k = v.k() << (11 - v.level());
    if (v.face != kInvalidId && on_edge(j, k)) points[{v.face, j, k}] = bits_of(v.position);
  }
  std::size_t compared = 0, refined = 0;
  for (const CapturedVertex& v : captured(*scene, {.levels = {.max_level = 4}})) {
    const auto found = points.find({v.face, v.j(), v.k()});
    if (!on_edge(v.j(), v.k()) || found == points.end()) continue;
    EXPECT_EQ(found->second, bits_of(v.position)) << "face " << v.face << " at " << v.j() << ", " << v.k();
    ++compared;
    refined += v.j() % 2048 != 0 || v.k() % 2048 != 0 ? 1 : 0;
  }
  EXPECT_GE(compared, points.size());
  EXPECT_GT(refined, 1000u);
}

TEST_F(HardwareTessellation, DrawsInstancesWhereTheyStand) {
  const Refiner knot = refiner(Shape::kKnot, 400), cube = refiner(Shape::kCube, 0);
  const Refiner* const objects[] = {&knot, &cube};
  Mat4 moved(1.0f);
  moved[3] = Vec4(3, 0, 0, 1);
  const RefinementInstance instances[] = {{1, Mat4(1.0f)}, {0, moved}, {1, moved}};
  auto scene = RefinementScene::create(*context_, objects, instances);
  ASSERT_TRUE(scene);
  std::vector<std::size_t> corners(3, 0);
  for (const CapturedVertex& v : captured(*scene, {.levels = {.criterion = Criterion::kUniform, .max_level = 2}}))
    ++corners[v.face >= scene->first_face(2) ? 2 : v.face >= scene->first_face(1) ? 1 : 0];
  for (std::size_t i = 0; i < 3; ++i)  // 24 triangles of four segments a side
    EXPECT_EQ(corners[i], 3 * 24 * scene->object_of(i).mesh().face_count());
}

TEST_F(HardwareTessellation, RefusesMoreSegmentsThanTheDeviceMakes) {
  const Refiner object = refiner(Shape::kCube, 0);
  auto scene = RefinementScene::create(*context_, object);
  ASSERT_TRUE(scene);
  const auto refused = HardwareTessellationMethod::create(*scene, {.levels = {.max_level = 8}});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kInvalidArgument);
  EXPECT_NE(format_error(refused.error()).find("2^8"), std::string::npos) << format_error(refused.error());
}

TEST(TessellatorTriangles, AreThoseOfTheSpecificationsExamples) {
  const auto count = [](TessellationSpacing spacing, std::array<float, 3> sides, float inner) {
    return tessellator_triangles(spacing, {sides[0], sides[1], sides[2]}, inner);
  };
  EXPECT_EQ(count(TessellationSpacing::kEqual, {1, 1, 1}, 1), 1u);
  EXPECT_EQ(count(TessellationSpacing::kEqual, {4, 1, 1}, 1), 6u);  // a fan about the middle
  EXPECT_EQ(count(TessellationSpacing::kEqual, {2, 2, 2}, 2), 6u);
  EXPECT_EQ(count(TessellationSpacing::kEqual, {3, 3, 3}, 3), 13u);
  EXPECT_EQ(count(TessellationSpacing::kEqual, {8, 8, 8}, 8), 96u);
  EXPECT_EQ(count(TessellationSpacing::kEqual, {0, 8, 8}, 8), 0u);
  EXPECT_EQ(count(TessellationSpacing::kFractionalOdd, {1, 1, 1}, 1), 1u);
  EXPECT_EQ(count(TessellationSpacing::kFractionalOdd, {1.5f, 1, 1}, 1), 3u + 1 + 1 + 4);
  EXPECT_EQ(count(TessellationSpacing::kFractionalEven, {1, 1, 1}, 1), 6u);
}

}  // namespace
}  // namespace limn::test
