#include <algorithm>
#include <cmath>
#include <cstring>
#include <epoxy/gl.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>
#include <optional>

#include "limn/mesh/normals.h"
#include "limn/render/camera_block.h"
#include "limn/render/materials.h"
#include "limn/render/targets.h"

#include "render/capture.h"
#include "render/drawing_test.h"
#include "render/refinement_bodies.h"

namespace limn::test {
namespace {

constexpr View kView{{Vec3(1.2f, 0.7f, 3.0f), false}, 1000.0f};

Mat4 placed(const Vec3& at, float turn_rad, float scale) {
  const Mat4 moved = glm::translate(Mat4(1.0f), at);
  return glm::scale(glm::rotate(moved, turn_rad, glm::normalize(Vec3(1, 2, -1))), Vec3(scale));
}

/// The view as an instance's object has it.
View in_object(const View& view, const Mat4& to_world) {
  const glm::dmat4 to_object = glm::inverse(glm::dmat4(to_world));
  View result = view;
  result.eye.at = Vec3(DVec3(to_object * glm::dvec4(DVec3(view.eye.at), view.eye.orthographic ? 0.0 : 1.0)));
  if (view.eye.orthographic) {
    const double scale = std::cbrt(std::abs(glm::determinant(glm::dmat3(to_world))));
    result.pixels_per_unit = static_cast<float>(double{view.pixels_per_unit} * scale);
  }
  return result;
}

bool same_bits(const std::vector<CapturedVertex>& a, const std::vector<CapturedVertex>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(CapturedVertex)) == 0;
}

std::size_t room_for(const PatternMethod& method) {
  return 3 * static_cast<std::size_t>(method.triangle_count()) + 100'000;
}

class SceneRefinement : public DrawingTest {
 protected:
  void SetUp() override {
    DrawingTest::SetUp();
    knot_.emplace(refiner_of(body(Shape::kKnot, 600), {}));
    asteroid_.emplace(refiner_of(body(Shape::kAsteroid, 320), {}));
  }

  PatternMethod method_of(RefinementScene& scene, const PatternMethodOptions& options = {}) {
    auto method = PatternMethod::create(scene, options);
    EXPECT_TRUE(method) << format_error(method.error());
    return std::move(*method);
  }
  RefinementScene scene_of(const Refiner& object, const RefinementSceneOptions& options = {}) {
    auto scene = RefinementScene::create(*context_, object, options);
    EXPECT_TRUE(scene) << format_error(scene.error());
    return std::move(*scene);
  }
  RefinementScene scene_of_four() {
    const Refiner* const objects[] = {&*knot_, &*asteroid_};
    auto scene = RefinementScene::create(*context_, objects, instances_);
    EXPECT_TRUE(scene) << format_error(scene.error());
    return std::move(*scene);
  }

  std::optional<Refiner> knot_, asteroid_;
  const std::vector<RefinementInstance> instances_ = {{0, placed(Vec3(0), 0.4f, 1.0f)},
                                                      {1, placed(Vec3(2.5f, 0, -1), 1.0f, 0.6f)},
                                                      {0, placed(Vec3(-3, 1, -2), -2.0f, 1.7f)},
                                                      {1, placed(Vec3(0, -2, 0.5f), 0.0f, 0.25f)}};
};

TEST_F(SceneRefinement, EachInstanceHasTheLevelsOfItsOwnViewpoint) {
  RefinementScene scene = scene_of_four();
  std::size_t differ = 0, all = 0, positive = 0;
  for (const bool orthographic : {false, true}) {
    for (const float pixels : {0.0f, 0.3f}) {
      LevelOptions options;
      options.pixels = pixels;
      auto pass = EdgeLevelPass::create(scene, options);
      ASSERT_TRUE(pass);
      View view = kView;
      view.eye.orthographic = orthographic;
      scene.set_view(view);
      pass->run();
      for (std::size_t i = 0; i < instances_.size(); ++i) {
        const Refiner& object = scene.object_of(i);
        const auto expected = edge_levels(object.mesh(), object.topology(), face_normals(object.mesh()),
                                          object.curves(), in_object(view, instances_[i].to_world), options);
        ASSERT_TRUE(expected);
        const std::vector<std::uint16_t> seen = pass->read(i);
        for (std::size_t e = 0; e < seen.size(); ++e, ++all) {
          const int off = std::abs(static_cast<int>(seen[e]) - static_cast<int>((*expected)[e] / kLevelUnit));
          ASSERT_LE(off, 1) << "instance " << i << " edge " << e << " pixels " << pixels;
          differ += off > 0 ? 1 : 0;
          positive += seen[e] > 0 ? 1 : 0;
        }
      }
    }
  }
  EXPECT_LT(static_cast<double>(differ), 2e-3 * static_cast<double>(all)) << differ;
  EXPECT_GT(positive, all / 10);
}

TEST_F(SceneRefinement, EachInstanceHasTheTrianglesOfItsOwnLevels) {
  RefinementScene scene = scene_of_four();
  PatternMethod method = method_of(scene);
  ASSERT_TRUE(method.refine(kView));
  const std::vector<CapturedVertex> seen = capture(method, room_for(method));
  std::vector<std::vector<Vec3>> corners(scene.face_capacity());
  std::size_t unrefined = 0, expected_unrefined = 0, expected_all = 0;
  for (const CapturedVertex& corner : seen) {
    if (corner.face == 0xffffffffu)
      ++unrefined;
    else
      corners[corner.face].push_back(corner.position);
  }
  for (std::size_t i = 0; i < instances_.size(); ++i) {
    const auto expected = scene.object_of(i).refine_with(levels_of(method, i));
    ASSERT_TRUE(expected);
    std::vector<std::vector<Vec3>> known(scene.object_of(i).mesh().face_count());
    for (std::size_t t = 0; t < expected->mesh.faces.size(); ++t) {
      for (const VertexId v : expected->mesh.faces[t])
        known[expected->source_face[t]].push_back(expected->mesh.positions[v]);
    }
    expected_all += expected->mesh.face_count();
    for (std::size_t f = 0; f < known.size(); ++f) {
      const std::vector<Vec3>& of_face = corners[scene.first_face(i) + f];
      if (known[f].size() == 3 && of_face.empty()) {
        expected_unrefined += 3;
        continue;
      }
      ASSERT_EQ(of_face.size(), known[f].size()) << "instance " << i << " face " << f;
      for (std::size_t c = 0; c < of_face.size(); ++c)
        ASSERT_LT(glm::length(of_face[c] - known[f][c]), 1e-6f) << "instance " << i << " face " << f;
    }
  }
  EXPECT_EQ(unrefined, expected_unrefined);
  EXPECT_EQ(seen.size(), 3 * expected_all);
  EXPECT_EQ(method.triangle_count(), expected_all);
}

/// Twisted about y; positions that were equal stay so, and normals that were equal at one position too.
Mesh twisted(Mesh mesh) {
  for (Vec3& p : mesh.positions) {
    const float turn = 0.8f * p.y;
    p = Vec3(std::cos(turn) * p.x - std::sin(turn) * p.z, 1.2f * p.y, std::sin(turn) * p.x + std::cos(turn) * p.z);
  }
  for (Vec3& n : mesh.normals.values)
    n = glm::normalize(Vec3(n.z, n.y + 0.3f * n.x, -n.x));
  return mesh;
}

TEST_F(SceneRefinement, AMeshMovedOnTheDeviceIsRefinedLikeOneMadeAnew) {
  for (const Shape shape : {Shape::kKnot, Shape::kCube}) {
    PatternMethodOptions options;
    options.store = true;
    const Mesh mesh = body(shape, 600);
    const Refiner before = refiner_of(mesh, options);
    const Refiner after = refiner_of(twisted(mesh), options);
    RefinementScene moving = scene_of(before, {.deforming = true});
    RefinementScene fresh = scene_of(after);
    ASSERT_EQ(moving.vertex_capacity(), fresh.vertex_capacity());
    PatternMethod moved = method_of(moving, options);
    PatternMethod made = method_of(fresh, options);
    ASSERT_TRUE(moved.refine(kView));
    const std::vector<std::uint16_t> levels_before = moved.levels().read(0);

    const std::vector<SceneVertex> vertices = fresh.read_vertices();
    for (std::size_t v = 0; v < moving.vertex_source(0).size(); ++v) {
      const auto at = static_cast<GLintptr>(v * sizeof(Vec3));
      glNamedBufferSubData(moving.positions_buffer(), at, sizeof(Vec3), &vertices[v].position);
      glNamedBufferSubData(moving.normals_buffer(), at, sizeof(Vec3), &vertices[v].normal);
    }
    moving.update_surface();
    ASSERT_TRUE(moved.refine(kView));
    ASSERT_TRUE(made.refine(kView));
    const std::vector<std::uint16_t> seen = moved.levels().read(0), expected = made.levels().read(0);
    EXPECT_NE(levels_before, expected);
    for (std::size_t e = 0; e < expected.size(); ++e)
      ASSERT_LE(std::abs(int{seen[e]} - int{expected[e]}), 1) << e;

    const std::vector<float> levels = levels_of(made);
    moved.levels().give(levels);
    made.levels().give(levels);
    ASSERT_TRUE(moved.refine(kView));
    ASSERT_TRUE(made.refine(kView));
    const Result<Mesh> a = moved.read(), b = made.read();
    ASSERT_TRUE(a && b);
    ASSERT_EQ(a->faces, b->faces);
    ASSERT_EQ(a->positions.size(), b->positions.size());
    for (std::size_t v = 0; v < a->positions.size(); ++v) {
      ASSERT_LT(glm::length(a->positions[v] - b->positions[v]), 1e-6f) << v;
      ASSERT_LT(glm::length(a->normals.values[v] - b->normals.values[v]), 1e-5f) << v;
    }
  }
}

TEST_F(SceneRefinement, ABudgetIsKeptAndSpent) {
  for (const PatternFamily family : {PatternFamily::kNested, PatternFamily::kMinimal}) {
    RefinementScene scene = scene_of_four();
    PatternMethodOptions options;
    options.family = family;
    PatternMethod free = method_of(scene, options);
    ASSERT_TRUE(free.refine(kView));
    const std::uint64_t most = free.triangle_count(), least = scene.triangle_count();
    ASSERT_GT(most, 3 * least);
    std::vector<float> wanted;
    for (std::size_t i = 0; i < instances_.size(); ++i) {
      const std::vector<float> levels = levels_of(free, i);
      wanted.insert(wanted.end(), levels.begin(), levels.end());
    }
    for (const std::uint64_t budget : {std::uint64_t{1}, least, least + 1, (2 * least + most) / 3, most - 1, most}) {
      options.triangle_budget = budget;
      PatternMethod method = method_of(scene, options);
      ASSERT_TRUE(method.refine(kView));
      const std::uint64_t count = method.triangle_count();
      EXPECT_LE(count, std::max(budget, least));
      EXPECT_GE(count, least);
      const std::vector<CapturedVertex> seen = capture(method, room_for(method));
      EXPECT_EQ(seen.size(), 3 * count);
      PatternMethod again = method_of(scene, options);
      ASSERT_TRUE(again.refine(kView));
      EXPECT_TRUE(same_bits(seen, capture(again, room_for(again)))) << "budget " << budget;

      std::uint32_t cut = 0;
      gl::read_buffer(method.selection().frame_buffer(), 0, std::as_writable_bytes(std::span(&cut, 1)));
      if (cut == 0) {
        EXPECT_EQ(count, most);
        continue;
      }
      // The next smaller cut would draw more than the budget.
      const std::uint32_t step = static_cast<std::uint32_t>(options.levels.max_level) * 4096 / 256;
      ASSERT_GE(cut, step);
      std::vector<float> levels = wanted;
      for (float& level : levels)
        level = std::max(0.0f, level - static_cast<float>(cut - step) * kLevelUnit);
      free.levels().give(levels);
      ASSERT_TRUE(free.refine(kView));
      EXPECT_GT(free.triangle_count(), budget) << "cut " << cut;
    }
  }
}

TEST_F(SceneRefinement, AFrozenViewKeepsItsTrianglesWhereverItIsDrawnFrom) {
  RefinementScene scene = scene_of_four();
  PatternMethod method = method_of(scene);
  ASSERT_TRUE(method.refine(kView));
  const std::uint64_t count = method.triangle_count();
  const std::vector<CapturedVertex> seen = capture(method, room_for(method));
  const auto targets = RenderTargets::create(64, 64, 1);
  const auto materials = MaterialTable::create(scene.meshes());
  ASSERT_TRUE(targets && materials);
  const CameraBuffer camera;
  for (const float turn : {0.0f, 1.0f, 3.0f}) {
    targets->begin_faces();
    materials->bind();
    camera.update(make_camera_block(fit_camera(Bounds{Vec3(-4), Vec3(4)}, turn, 0.2f), 64, 64));
    camera.bind();
    ASSERT_TRUE(method.draw({}));
    ASSERT_TRUE(method.draw({.stage = SurfaceStage::kPositions}));
    EXPECT_EQ(method.triangle_count(), count);
    EXPECT_TRUE(same_bits(capture(method, room_for(method)), seen)) << turn;
  }
  ASSERT_TRUE(method.refine({{Vec3(-3, 1, 0), false}, 1000.0f}));
  EXPECT_FALSE(same_bits(capture(method, room_for(method)), seen));
}

TEST_F(SceneRefinement, TwoMethodsDrawTheSameBits) {
  for (PatternMethodOptions options : families_and_blends()) {
    RefinementScene one = scene_of_four(), two = scene_of_four();
    PatternMethod first = method_of(one, options), second = method_of(two, options);
    ASSERT_TRUE(first.refine(kView));
    ASSERT_TRUE(second.refine(kView));
    EXPECT_TRUE(same_bits(capture(first, room_for(first)), capture(second, room_for(second)))) << name_of(options);
  }
}

TEST_F(SceneRefinement, FacesKeepTheirMaterials) {
  Mesh mesh = body(Shape::kIcosphere, 320);
  mesh.uvs = {};
  mesh.materials.resize(2);
  mesh.materials[0].base_color = Vec4(0.8f, 0.05f, 0.05f, 1);
  mesh.materials[1].base_color = Vec4(0.05f, 0.7f, 0.05f, 1);
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    mesh.face_materials.push_back(mesh.positions[mesh.faces[f][0]].x > 0.0f ? 1 : 0);
  const Camera camera = fit_camera(face_bounds(mesh), 0.5f, 0.3f);
  const RenderOptions picture = picture_options(128, 128, 1, kWhite);
  for (const bool store : {false, true}) {
    PatternMethodOptions options;
    options.store = store;
    const Refiner object = refiner_of(mesh, options);
    RefinementScene scene = scene_of(object);
    PatternMethod method = method_of(scene, options);
    const View view = view_of(camera, 128);
    ASSERT_TRUE(method.refine(view));
    const auto targets = RenderTargets::create(128, 128, 1);
    const auto materials = MaterialTable::create(scene.meshes());
    ASSERT_TRUE(targets && materials);
    targets->begin_faces();
    materials->bind();
    const CameraBuffer block;
    block.update(make_camera_block(camera, 128, 128));
    block.bind();
    ASSERT_TRUE(method.draw({}));
    const auto seen = targets->resolve(*context_, kWhite);
    ASSERT_TRUE(seen);
    const auto refined = object.refine_with(levels_of(method));
    ASSERT_TRUE(refined);
    EXPECT_LT(compare_images(*seen, draw(refined->mesh, camera, picture), 2).failing_share, 0.002) << store;
    EXPECT_GT(compare_images(*seen, draw(object.mesh(), camera, picture), 2).failing_share, 0.002) << store;
  }
}

TEST_F(SceneRefinement, IsStoredWithAsMuchRoomAsTheDeviceHas) {
  PatternMethodOptions options;
  options.store = true;
  options.levels.max_level = 5;  // deep enough that not even one largest pattern a face fits
  const Refiner object = refiner_of(body(Shape::kKnot, 35'000), options);
  RefinementScene scene = scene_of(object);
  PatternMethod method = method_of(scene, options);
  const std::size_t room = StoredSurface::most_triangles(scene, method.patterns(), true);
  ASSERT_TRUE(method.refine(kView));
  EXPECT_LE(method.triangle_count(), std::min<std::uint64_t>(room, kStoredTriangles));
  options.triangle_budget = room + 1;
  EXPECT_FALSE(PatternMethod::create(scene, options));
}

TEST_F(SceneRefinement, MemoryStaysWithinNinetySixBytesAFace) {
  for (const PatternFamily family : {PatternFamily::kNested, PatternFamily::kMinimal}) {
    for (const std::size_t faces : {10'000u, 100'000u}) {
      PatternMethodOptions options;
      options.family = family;
      const Refiner object = refiner_of(body(Shape::kKnot, faces), options);
      RefinementScene scene = scene_of(object);
      const PatternMethod method = method_of(scene, options);
      const double bytes = static_cast<double>(method.device_bytes()) / static_cast<double>(object.mesh().face_count());
      EXPECT_LE(bytes, 96.0) << faces << " faces";
      EXPECT_LE(method.patterns().bytes(), 8192u);
      RecordProperty("bytes_a_face_" + name_of(options) + "_" + std::to_string(faces), std::to_string(bytes));
      RecordProperty("patterns_" + name_of(options) + "_" + std::to_string(faces),
                     std::to_string(method.patterns().bytes()));
    }
  }
}

}  // namespace
}  // namespace limn::test
