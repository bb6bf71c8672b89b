// Clipped models cover exactly the pixels that the originals cover, wherever the eye is.
#include <glm/ext/matrix_transform.hpp>

#include "limn/base/random.h"
#include "limn/render/clip/clip_picture.h"

#include "clip_bodies.h"

namespace limn {
namespace {

using test::asset_of;
using test::kTransparent;
using test::picture_options;

class ClipExact : public test::DrawingTest {
 protected:
  ClipPicture clip(ClipModel& model, const Camera& camera, const RenderOptions& options, ClipDrawOptions clip = {}) {
    clip.level_tolerance_px = 0;
    const ClipInstance instance{&model, Mat4(1.0f)};
    auto picture = render_clipped(*context_, std::span(&instance, 1), camera, options, clip);
    EXPECT_TRUE(picture) << format_error(picture.error());
    return picture ? std::move(*picture) : ClipPicture{Image(options.width, options.height), {ClipDrawn{}}, 0};
  }

  ClipModel model_of(const ClipAsset& asset) {
    auto model = ClipModel::create(*context_, asset);
    EXPECT_TRUE(model) << format_error(model.error());
    return std::move(*model);
  }

  /// Compares and returns where the eye was.
  EyePlace expect_same(ClipModel& model, const Mesh& original, const Camera& camera, int size_px, int samples = 1) {
    const RenderOptions options = picture_options(size_px, size_px, samples, kTransparent);
    const ClipPicture picture = clip(model, camera, options);
    const Image wanted = draw(original, camera, options);
    std::size_t differing = 0;
    for (std::size_t i = 3; i < wanted.rgba.size(); i += 4)
      differing += wanted.rgba[i] != picture.image.rgba[i] ? 1 : 0;
    EXPECT_EQ(differing, 0u);
    covered_ += wanted.rgba.size() / 4 - test::count_differing(wanted, Image(size_px, size_px)) > 0 ? 1 : 0;
    return picture.drawn.front().place;
  }
  std::size_t covered_ = 0;
};

Camera loose(Camera camera) {
  camera.near_distance *= 0.5f;
  camera.far_distance *= 1.5f;
  return camera;
}

TEST_F(ClipExact, FromAllAroundInBothProjections) {
  Random random(2);
  for (const Shape kind : {Shape::kKnot, Shape::kHoles3, Shape::kAsteroid}) {
    const Mesh mesh = test::shape(kind, 30000);
    ClipModel model = model_of(asset_of(mesh));
    for (int view = 0; view < 6; ++view) {
      CameraFit fit;
      fit.orthographic = view % 3 == 2;
      fit.fov_rad = view % 3 == 1 ? 1.2f : 0.6f;
      fit.fill = view < 4 ? 0.9f : 2.0f;  // beyond the picture's borders
      const Camera camera = loose(fit_camera(face_bounds(mesh), random.direction(), fit));
      EXPECT_EQ(expect_same(model, mesh, camera, 256 + 64 * view), EyePlace::kOutside);
    }
  }
}

TEST_F(ClipExact, OfSmallPicturesOfManyFaces) {
  Random random(4);
  const Mesh mesh = test::shape(Shape::kKnot, 60000);
  ClipModel model = model_of(asset_of(mesh));
  for (int view = 0; view < 10; ++view)
    expect_same(model, mesh, loose(fit_camera(face_bounds(mesh), random.direction())), 32 + 5 * view);
}

TEST_F(ClipExact, EverySampleOfFour) {
  Random random(6);
  const Mesh mesh = test::shape(Shape::kHoles3, 20000);
  ClipModel model = model_of(asset_of(mesh));
  for (int view = 0; view < 4; ++view)
    expect_same(model, mesh, loose(fit_camera(face_bounds(mesh), random.direction())), 200, 4);
}

TEST_F(ClipExact, WhereTheHullIsTheOriginal) {
  // Every edge of the outline is the hull's as well: not a pixel may be lost between the two.
  Random random(8);
  for (const Shape kind : {Shape::kCube, Shape::kIcosphere, Shape::kKnot}) {
    const Mesh mesh = test::shape(kind, kind == Shape::kCube ? 1200 : 1280);
    ClipModel model = model_of(asset_of(mesh, mesh));
    for (int view = 0; view < 6; ++view)
      expect_same(model, mesh, loose(fit_camera(face_bounds(mesh), random.direction())), 300);
  }
}

/// A box whose edges the original's are parts of.
TEST_F(ClipExact, WhereAnEdgeOfTheHullHoldsManyOfTheOriginal) {
  Mesh fine = test::shape(Shape::kCube, 3 * 4 * 1024), coarse = test::shape(Shape::kCube, 12);
  Random random(9);
  ClipModel model = model_of(asset_of(fine, coarse));
  for (int view = 0; view < 8; ++view)
    expect_same(model, fine, loose(fit_camera(face_bounds(fine), random.direction())), 333);
}

Camera looking(const Vec3& eye, const Vec3& target, float fov_rad = 1.2f) {
  Camera camera;
  camera.eye = eye;
  camera.target = target;
  camera.fov_rad = fov_rad;
  camera.near_distance = 0.01f;
  camera.far_distance = 20.0f;
  return camera;
}

/// A knot's own tube a little wider: a hull that leaves its holes open.
Mesh knot_hull(float share) {
  Mesh hull = test::shape(Shape::kKnot, 4000);
  for (std::size_t v = 0; v < hull.positions.size(); ++v)
    hull.positions[v] += share * hull.normals.values[v];
  return hull;
}

TEST_F(ClipExact, FromWithinTheConvexHull) {
  const Mesh mesh = test::shape(Shape::kKnot, 20000);
  ClipModel model = model_of(asset_of(mesh, knot_hull(0.02f)));
  Random random(12);
  for (int view = 0; view < 8; ++view) {
    const Vec3 away = random.direction();
    EXPECT_EQ(expect_same(model, mesh, looking(Vec3(0.0f), away), 256), EyePlace::kBetween);
  }
}

TEST_F(ClipExact, FromWithinTheSurfaceAndWhereThePlanesCutIt) {
  const Mesh mesh = test::shape(Shape::kIcosphere, 5120);
  ClipModel model = model_of(asset_of(mesh));
  EXPECT_EQ(expect_same(model, mesh, looking(Vec3(0.1f, 0.2f, 0.0f), Vec3(1, 0, 0)), 200), EyePlace::kInside);
  Camera camera = loose(fit_camera(face_bounds(mesh), Vec3(0, 0, 1)));
  camera.near_distance = glm::length(camera.eye - camera.target) - 0.3f;
  EXPECT_EQ(expect_same(model, mesh, camera, 200), EyePlace::kInside);
  camera = loose(fit_camera(face_bounds(mesh), Vec3(0, 0, 1), {.orthographic = true}));
  camera.near_distance = glm::length(camera.eye - camera.target) - 0.3f;
  EXPECT_EQ(expect_same(model, mesh, camera, 200), EyePlace::kInside);
  camera = loose(fit_camera(face_bounds(mesh), Vec3(0, 0, 1)));
  camera.far_distance = glm::length(camera.eye - camera.target) + 0.3f;
  EXPECT_EQ(expect_same(model, mesh, camera, 200), EyePlace::kInside);
}

/// Beside a long body, part of which is behind the viewer, and none before the near plane.
TEST_F(ClipExact, BesideAModelThatReachesBehindTheEye) {
  Mesh mesh = test::shape(Shape::kIcosphere, 5120);
  for (Vec3& p : mesh.positions)
    p.z *= 8.0f;
  Mesh hull = mesh;
  for (Vec3& p : hull.positions)
    p *= 1.01f;
  ClipModel model = model_of(asset_of(mesh, hull));
  EXPECT_EQ(expect_same(model, mesh, looking(Vec3(1.6f, 0.3f, 1.0f), Vec3(0.4f, 0.0f, -6.0f)), 256),
            EyePlace::kOutside);
  EXPECT_EQ(expect_same(model, mesh, looking(Vec3(1.6f, 0.3f, 1.0f), Vec3(-1.0f, 0.0f, 1.0f), 2.4f), 256),
            EyePlace::kOutside);
}

TEST_F(ClipExact, TinyAndHugeModels) {
  for (const float size : {1e-4f, 1e5f}) {
    Mesh mesh = test::shape(Shape::kKnot, 5000);
    for (Vec3& p : mesh.positions)
      p *= size;
    ClipModel model = model_of(asset_of(mesh));
    expect_same(model, mesh, loose(fit_camera(face_bounds(mesh), view_direction(0.4f, 0.3f))), 256);
  }
}

TEST_F(ClipExact, OpenMeshesAreRefused) {
  Mesh open = test::shape(Shape::kKnot, 1000);
  open.faces.pop_back();
  const auto model = ClipModel::create(*context_, asset_of(open));
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().code, ErrorCode::kUnsuitable);
  EXPECT_FALSE(ClipModel::create(*context_, ClipAsset{}));
}

}  // namespace
}  // namespace limn
