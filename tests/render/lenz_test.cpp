// Lenz's patterns as published and the methods they are compared with: all from equal levels.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <map>
#include <set>

#include "limn/base/random.h"
#include "limn/mesh/normals.h"
#include "limn/mesh/shapes.h"
#include "limn/render/camera_block.h"
#include "limn/render/materials.h"
#include "limn/render/refinement/patterns.h"
#include "limn/render/refinement/published/ark.h"
#include "limn/render/refinement/published/arkfpi.h"
#include "limn/render/refinement/published/dmr.h"
#include "limn/render/refinement/published/side_patterns.h"
#include "limn/render/refinement/published/suapt.h"
#include "limn/render/refinement/published/uniform_patterns.h"
#include "limn/render/targets.h"

#include "render/capture.h"
#include "render/drawing_test.h"
#include "support/stable.h"

namespace limn::test {
namespace {

constexpr int kDeepest = 3;
const View kView{{Vec3(1.2f, 0.7f, 3.0f), false}, 1000.0f};

LevelOptions up_to(int level) {
  LevelOptions options;
  options.max_level = level;
  return options;
}

Refiner refiner(Mesh mesh) {
  auto made = Refiner::create(std::move(mesh));
  EXPECT_TRUE(made) << format_error(made.error());
  return std::move(*made);
}

Refiner shape(Shape kind, std::size_t faces) {
  auto mesh = make_shape(kind, {.faces = faces});
  EXPECT_TRUE(mesh) << format_error(mesh.error());
  return refiner(std::move(*mesh));
}

/// Whole levels up to the deepest, one an edge.
std::vector<float> random_levels(const Refiner& object, std::uint64_t seed, int deepest = kDeepest) {
  Random random(seed);
  std::vector<float> levels(object.topology().edge_count());
  for (float& level : levels)
    level = static_cast<float>(random.below(static_cast<std::uint64_t>(deepest) + 1));
  return levels;
}

using Bits = std::array<std::uint32_t, 3>;
Bits bits_of(const Vec3& p) {
  const Vec3 q = p + Vec3(0.0f);  // one zero
  return {std::bit_cast<std::uint32_t>(q.x), std::bit_cast<std::uint32_t>(q.y), std::bit_cast<std::uint32_t>(q.z)};
}

/// A triangle from its smallest corner on; turning it over makes it another.
template <class T>
std::array<T, 3> from_smallest(std::array<T, 3> corners) {
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  return corners;
}

/// What is drawn, in an order of its own: refined triangles by face and places on it, unrefined ones by their corners.
struct Drawn {
  std::map<std::pair<std::uint32_t, std::array<std::uint32_t, 3>>, std::array<Vec3, 3>> refined;
  std::vector<std::array<Bits, 3>> unrefined;
  std::size_t triangles = 0;
};

Drawn sorted(const std::vector<CapturedVertex>& seen) {
  Drawn drawn;
  drawn.triangles = seen.size() / 3;
  for (std::size_t i = 0; i + 2 < seen.size(); i += 3) {
    const CapturedVertex* const v = &seen[i];
    if (v->face == 0xffffffffu || v->level() == 0) {
      drawn.unrefined.push_back(
          from_smallest(std::array{bits_of(v[0].position), bits_of(v[1].position), bits_of(v[2].position)}));
      continue;
    }
    const std::array places{v[0].place, v[1].place, v[2].place};
    const auto first = static_cast<std::size_t>(std::min_element(places.begin(), places.end()) - places.begin());
    const auto [at, fresh] =
        drawn.refined.insert({{v->face, from_smallest(places)},
                              {v[first].position, v[(first + 1) % 3].position, v[(first + 2) % 3].position}});
    EXPECT_TRUE(fresh) << "a triangle of face " << v->face << " is drawn twice";
  }
  std::sort(drawn.unrefined.begin(), drawn.unrefined.end());
  return drawn;
}

void expect_same(const Drawn& a, const Drawn& b, float diagonal) {
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_TRUE(a.unrefined == b.unrefined);
  ASSERT_EQ(a.refined.size(), b.refined.size());
  float worst = 0.0f;
  for (auto [one, other] = std::pair(a.refined.begin(), b.refined.begin()); one != a.refined.end(); ++one, ++other) {
    ASSERT_EQ(one->first, other->first);
    for (std::size_t c = 0; c < 3; ++c)
      worst = std::max(worst, glm::length(one->second[c] - other->second[c]));
  }
  EXPECT_LE(worst, 4e-7f * diagonal);
}

/// A method, which one, and what it draws at most.
struct Contestant {
  std::string name;
  std::function<std::unique_ptr<RefinementMethod>(RefinementScene&, std::span<const float>)> make;
};

template <class Method, class... More>
std::unique_ptr<RefinementMethod> with_levels(RefinementScene& scene, std::span<const float> levels, More... more) {
  auto method = Method::create(scene, more...);
  EXPECT_TRUE(method) << format_error(method.error());
  method->give_levels(levels);
  return std::make_unique<Method>(std::move(*method));
}

std::vector<Contestant> adaptive_methods() {
  return {
      {"ark", [](auto& scene, auto levels) { return with_levels<ArkMethod>(scene, levels, up_to(kDeepest)); }},
      {"arkfpi", [](auto& scene, auto levels) { return with_levels<ArkfpiMethod>(scene, levels, up_to(kDeepest)); }},
      {"dmr", [](auto& scene, auto levels) {
         return with_levels<DmrMethod>(scene, levels, DmrOptions{up_to(kDeepest), 4});
       }}};
}

std::vector<Contestant> all_methods() {
  std::vector<Contestant> all = adaptive_methods();
  all.push_back(
      {"suapt", [](auto& scene, auto levels) { return with_levels<SuaptMethod>(scene, levels, up_to(kDeepest)); }});
  all.push_back({"uniform", [](auto& scene, auto) -> std::unique_ptr<RefinementMethod> {
                   auto method = UniformPatternsMethod::create(scene, kDeepest);
                   EXPECT_TRUE(method) << format_error(method.error());
                   return std::make_unique<UniformPatternsMethod>(std::move(*method));
                 }});
  return all;
}

/// What the method draws after refine(), which says how many triangles that is.
std::vector<CapturedVertex> drawn_by(RefinementMethod& method) {
  EXPECT_TRUE(method.refine(kView));
  const std::uint64_t count = method.triangle_count();
  std::vector<CapturedVertex> seen = capture(method, 3 * count + 3000);  // gaps of the default's
  EXPECT_EQ(seen.size(), 3 * count);
  return seen;
}

class Lenz : public DrawingTest {
 protected:
  RefinementScene scene_of(const Refiner& object) {
    auto scene = RefinementScene::create(*context_, object);
    EXPECT_TRUE(scene) << format_error(scene.error());
    return std::move(*scene);
  }

  Image picture(RefinementScene& scene, RefinementMethod& method, const SurfacePass& pass, int size) {
    const Camera camera = fit_camera(face_bounds(scene.object_of(0).mesh()), 0.7f, 0.4f);
    EXPECT_TRUE(method.refine(view_of(camera, size)));
    const auto targets = RenderTargets::create(size, size, 1);
    const auto materials = MaterialTable::create(scene.meshes());
    EXPECT_TRUE(targets && materials);
    targets->begin_faces();
    const CameraBuffer buffer;
    buffer.update(make_camera_block(camera, size, size));
    buffer.bind();
    materials->bind();
    const auto drawn = method.draw(pass);
    EXPECT_TRUE(drawn) << format_error(drawn.error());
    auto image = targets->resolve(*context_, kTransparent);
    EXPECT_TRUE(image);
    return std::move(*image);
  }
};

TEST_F(Lenz, ArkArkfpiDmrAndTheDefaultDrawTheSameTriangles) {
  for (const Shape kind : {Shape::kKnot, Shape::kAsteroid, Shape::kHoles3, Shape::kCube, Shape::kSheet}) {
    const Refiner object = shape(kind, 400);
    RefinementScene scene = scene_of(object);
    const std::vector<float> levels = random_levels(object, 11);
    PatternMethodOptions options;
    options.levels = up_to(kDeepest);
    options.family = PatternFamily::kMinimal;
    options.blend = Blend::kPaper;
    auto patterns = PatternMethod::create(scene, options);
    ASSERT_TRUE(patterns) << format_error(patterns.error());
    patterns->levels().give(levels);
    const Drawn expected = sorted(drawn_by(*patterns));
    EXPECT_GT(expected.refined.size(), object.topology().face_count());
    for (const Contestant& contestant : adaptive_methods()) {
      SCOPED_TRACE(contestant.name);
      const auto method = contestant.make(scene, levels);
      expect_same(sorted(drawn_by(*method)), expected, static_cast<float>(face_bounds(object.mesh()).diagonal()));
    }
  }
}

TEST_F(Lenz, LevelsAreThoseOfTheViewRoundedUp) {
  const Refiner object = shape(Shape::kKnot, 500);
  RefinementScene scene = scene_of(object);
  auto method = ArkfpiMethod::create(scene, up_to(kDeepest));
  ASSERT_TRUE(method);
  const auto levels = edge_levels(object.mesh(), object.topology(), face_normals(object.mesh()), object.curves(), kView,
                                  up_to(kDeepest));
  ASSERT_TRUE(levels);
  std::uint64_t triangles = 0;
  const PatternTable table = pattern_table(PatternFamily::kMinimal, kDeepest);
  for (const auto& edges : object.topology().face_edges) {
    PatternConfig config;
    for (std::size_t c = 0; c < 3; ++c)
      config.sides[c] = static_cast<std::uint8_t>(std::ceil((*levels)[edges[c]]));
    triangles += table.ranges[choose_pattern(PatternFamily::kMinimal, config).base].triangle_count;
  }
  EXPECT_EQ(sorted(drawn_by(*method)).triangles, triangles);
  EXPECT_GT(triangles, object.topology().face_count());
}

/// Edges that are not met by as many the other way, or, where faces are not all wound alike, by one at all; those
/// between corners in one place do not count.
std::size_t open_edges(const std::vector<CapturedVertex>& seen, bool wound_alike = true) {
  std::map<std::pair<Bits, Bits>, std::pair<int, int>> uses;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const Bits a = bits_of(seen[i].position);
    const Bits b = bits_of(seen[i % 3 == 2 ? i - 2 : i + 1].position);
    if (a < b) ++uses[{a, b}].first;
    if (b < a) ++uses[{b, a}].second;
  }
  return static_cast<std::size_t>(std::count_if(uses.begin(), uses.end(), [wound_alike](const auto& edge) {
    const auto& [forth, back] = edge.second;
    return wound_alike ? forth != back : (forth + back) % 2 != 0;
  }));
}

TEST_F(Lenz, EveryMethodIsWatertightBitForBit) {
  std::vector<StableMesh> meshes = awkward_meshes();
  for (const Shape kind : {Shape::kKnot, Shape::kHoles3, Shape::kCube})
    meshes.push_back({"shape", *make_shape(kind, {.faces = 400}), true, true});
  std::size_t tested = 0;
  for (const StableMesh& stable : meshes) {
    if (!stable.closed || !stable.manifold || stable.mesh.faces.size() > 2000) continue;
    const auto object = Refiner::create(stable.mesh);
    if (!object) continue;
    RefinementScene scene = scene_of(*object);
    const std::vector<float> levels = random_levels(*object, 5 + tested);
    const auto& classes = object->topology().edge_class;
    const bool wound_alike = std::count(classes.begin(), classes.end(), EdgeClass::kInconsistent) == 0;
    for (const Contestant& contestant : all_methods()) {
      const auto method = contestant.make(scene, levels);
      EXPECT_EQ(open_edges(drawn_by(*method), wound_alike), 0u) << contestant.name << " of " << stable.name;
    }
    ++tested;
  }
  EXPECT_GE(tested, 10u);
}

TEST_F(Lenz, AnOpenEdgeIsSeenByTheTest) {
  const Refiner object = shape(Shape::kSheet, 200);
  RefinementScene scene = scene_of(object);
  const auto method = all_methods()[0].make(scene, random_levels(object, 1));
  EXPECT_GT(open_edges(drawn_by(*method)), 0u);
}

TEST_F(Lenz, UniformPatternsCutEveryFaceAlike) {
  const Refiner object = shape(Shape::kKnot, 300);
  RefinementScene scene = scene_of(object);
  for (int level = 0; level <= 4; ++level) {
    auto method = UniformPatternsMethod::create(scene, level);
    ASSERT_TRUE(method);
    const std::vector<CapturedVertex> seen = drawn_by(*method);
    EXPECT_EQ(seen.size(), 3 * object.topology().face_count() << 2 * level);
    for (const CapturedVertex& v : seen)
      ASSERT_EQ(v.level(), static_cast<std::uint32_t>(level));
  }
  for (const int level : {-1, kMaxLevel + 1}) {
    const auto refused = UniformPatternsMethod::create(scene, level);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::kInvalidArgument);
  }
}

/// Twice the triangle's area on its face, in cells of the grid.
std::int64_t area_on_face(const CapturedVertex* v) {
  const auto difference = [](std::uint32_t a, std::uint32_t b) { return std::int64_t{a} - std::int64_t{b}; };
  return difference(v[1].j(), v[0].j()) * difference(v[2].k(), v[0].k()) -
         difference(v[1].k(), v[0].k()) * difference(v[2].j(), v[0].j());
}

TEST_F(Lenz, MergedBordersTurnNoTriangleOverAndCoverTheFace) {
  const Refiner object = shape(Shape::kKnot, 2000);  // each of the 64 combinations of levels, many times
  RefinementScene scene = scene_of(object);
  const std::vector<float> levels = random_levels(object, 3);
  auto method = SuaptMethod::create(scene, up_to(kDeepest));
  ASSERT_TRUE(method);
  method->give_levels(levels);
  const std::vector<CapturedVertex> seen = drawn_by(*method);
  EXPECT_LE(method->call_count(), static_cast<std::size_t>(kDeepest) + 1);
  std::vector<std::int64_t> area(object.topology().face_count(), 0), count(area);
  for (std::size_t i = 0; i < seen.size(); i += 3) {
    const std::int64_t own = area_on_face(&seen[i]);
    ASSERT_GE(own, 0) << "face " << seen[i].face;
    area[seen[i].face] += own;
    ++count[seen[i].face];
  }
  for (std::size_t f = 0; f < area.size(); ++f) {
    float largest = 0.0f;
    for (const EdgeId e : object.topology().face_edges[f])
      largest = std::max(largest, levels[e]);
    const std::int64_t triangles = std::int64_t{1} << 2 * static_cast<int>(largest);
    ASSERT_EQ(count[f], triangles);
    ASSERT_EQ(area[f], triangles);
  }
}

TEST_F(Lenz, MergedBordersHaveJustTheSidesOwnPoints) {
  const Refiner object = shape(Shape::kAsteroid, 500);
  RefinementScene scene = scene_of(object);
  const std::vector<float> levels = random_levels(object, 8);
  const auto method = with_levels<SuaptMethod>(scene, levels, up_to(kDeepest));
  std::map<EdgeId, std::set<Bits>> points;
  for (const CapturedVertex& v : drawn_by(*method)) {
    const std::uint32_t weights[3] = {(1u << v.level()) - v.j() - v.k(), v.j(), v.k()};
    for (std::size_t c = 0; c < 3; ++c) {
      if (weights[(c + 2) % 3] == 0) points[object.topology().face_edges[v.face][c]].insert(bits_of(v.position));
    }
  }
  ASSERT_EQ(points.size(), levels.size());
  for (const auto& [edge, seen] : points)
    ASSERT_EQ(seen.size(), (std::size_t{1} << static_cast<int>(levels[edge])) + 1) << "edge " << edge;
}

TEST_F(Lenz, FacesAreGroupedByBasePatternAndWinding) {
  const Refiner object = shape(Shape::kKnot, 2000);
  RefinementScene scene = scene_of(object);
  const std::vector<float> levels = random_levels(object, 21);
  auto method = ArkfpiMethod::create(scene, up_to(kDeepest));
  ASSERT_TRUE(method);
  method->give_levels(levels);
  ASSERT_TRUE(method->refine(kView));
  std::map<std::pair<std::uint32_t, bool>, std::uint32_t> expected;
  for (const auto& edges : object.topology().face_edges) {
    PatternConfig config;
    for (std::size_t c = 0; c < 3; ++c)
      config.sides[c] = static_cast<std::uint8_t>(levels[edges[c]]);
    const PatternChoice choice = choose_pattern(PatternFamily::kMinimal, config);
    ++expected[{choice.base, choice.mirrored}];
  }
  const std::vector<ArkfpiMethod::Group> groups = method->groups();
  ASSERT_EQ(groups.size(), expected.size());
  EXPECT_LE(groups.size(), 2 * method->stored_patterns());
  for (const ArkfpiMethod::Group& group : groups)
    EXPECT_EQ(group.faces, (expected[{group.base, group.mirrored}])) << group.base;
}

TEST_F(Lenz, SortedPatternsAreAFractionOfAllOfThem) {
  EXPECT_EQ(all_sides(9).size(), 1000u);  // N = 10 levels
  EXPECT_EQ(pattern_count(PatternFamily::kMinimal, 9), 220u);
  const Refiner object = shape(Shape::kCube, 12);
  RefinementScene scene = scene_of(object);
  for (int deepest = 0; deepest <= 5; ++deepest) {
    const auto n = static_cast<std::size_t>(deepest) + 1;
    const auto ark = ArkMethod::create(scene, up_to(deepest));
    const auto arkfpi = ArkfpiMethod::create(scene, up_to(deepest));
    ASSERT_TRUE(ark && arkfpi);
    EXPECT_EQ(ark->stored_patterns(), n * n * n);
    EXPECT_EQ(arkfpi->stored_patterns(), n * (n + 1) * (n + 2) / 6);
    EXPECT_EQ(arkfpi->stored_patterns(), (n * n * n + 3 * n * n + 2 * n) / 6);  // equation (2)
    EXPECT_TRUE(deepest < 2 || arkfpi->pattern_bytes() < ark->device_bytes());
    RecordProperty("bytes_ark_" + std::to_string(deepest), std::to_string(ark->device_bytes()));
    RecordProperty("bytes_arkfpi_" + std::to_string(deepest), std::to_string(arkfpi->pattern_bytes()));
  }
}

TEST_F(Lenz, ARefinedMeshFollowsItsLevelsFromFrameToFrame) {
  const Refiner object = shape(Shape::kAsteroid, 300);
  RefinementScene scene = scene_of(object);
  const auto diagonal = static_cast<float>(face_bounds(object.mesh()).diagonal());
  auto arkfpi = ArkfpiMethod::create(scene, up_to(kDeepest));
  ASSERT_TRUE(arkfpi);
  for (const auto& [most, passes] : {std::pair(2, 6), std::pair(5, 3), std::pair(32, 2)}) {
    auto dmr = DmrMethod::create(scene, {up_to(kDeepest), most});
    ASSERT_TRUE(dmr) << format_error(dmr.error());
    EXPECT_EQ(dmr->pass_count(), passes);
    for (const int deepest : {3, 0, 1, 3, 2, 2}) {
      const std::vector<float> levels = random_levels(object, static_cast<std::uint64_t>(most), deepest);
      dmr->give_levels(levels);
      arkfpi->give_levels(levels);
      expect_same(sorted(drawn_by(*dmr)), sorted(drawn_by(*arkfpi)), diagonal);
    }
  }
  for (const int most : {1, 33}) {
    const auto refused = DmrMethod::create(scene, {up_to(kDeepest), most});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::kInvalidArgument);
  }
}

/// A knot of two materials with texture coordinates that have seams, and a colour a vertex.
Mesh painted_knot() {
  Mesh mesh = *make_shape(Shape::kKnot, {.faces = 600});
  for (const Vec3& p : mesh.positions)
    mesh.colors.values.emplace_back(0.5f + 0.5f * p.x, 0.5f + 0.5f * p.y, 0.5f + 0.5f * p.z, 1.0f);
  Image checks(16, 16);
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x)
      std::fill_n(checks.pixel(x, y), 4, static_cast<std::uint8_t>((x / 2 + y / 8) % 2 == 0 ? 255 : 90));
  }
  mesh.materials.resize(2);
  for (Material& material : mesh.materials) {
    material.base_color_image = png_of(checks);
    material.base_color_image_mime = "image/png";
  }
  mesh.materials[0].base_color = Vec4(1.0f, 0.6f, 0.3f, 1.0f);
  mesh.materials[1].base_color = Vec4(0.3f, 0.6f, 1.0f, 1.0f);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    mesh.face_materials.push_back(static_cast<std::uint32_t>(f / 100 % 2));
  return mesh;
}

/// Pixels that one of two pictures covers and the other does not, over those that either covers.
double uncommon_share(const Image& a, const Image& b) {
  std::size_t either = 0, one = 0;
  for (std::size_t i = 3; i < a.rgba.size(); i += 4) {
    either += a.rgba[i] != 0 || b.rgba[i] != 0 ? 1 : 0;
    one += (a.rgba[i] != 0) != (b.rgba[i] != 0) ? 1 : 0;
  }
  return static_cast<double>(one) / static_cast<double>(either);
}

TEST_F(Lenz, PicturesAgree) {
  const Refiner object = refiner(painted_knot());
  RefinementScene scene = scene_of(object);
  const std::vector<float> levels = random_levels(object, 4);
  const auto reference = adaptive_methods()[1].make(scene, levels);
  for (const Contestant& contestant : all_methods()) {
    const auto method = contestant.make(scene, levels);
    for (const bool wireframe : {false, true}) {
      SCOPED_TRACE(contestant.name + (wireframe ? " wires" : ""));
      const SurfacePass pass{.wireframe = wireframe};
      const Image expected = picture(scene, *reference, pass, 256);
      const Image seen = picture(scene, *method, pass, 256);
      EXPECT_LT(uncommon_share(seen, expected), 0.02);
      if (contestant.name == "suapt" || contestant.name == "uniform") continue;
      EXPECT_LT(compare_images(seen, expected, 2).failing_share, 1e-3);
    }
  }
}

}  // namespace
}  // namespace limn::test
