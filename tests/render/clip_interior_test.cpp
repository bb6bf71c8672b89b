#include <algorithm>
#include <cmath>
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include "limn/asset/build.h"
#include "limn/render/clip/clip_picture.h"
#include "limn/render/clip/hull_shell.h"

#include "clip_bodies.h"

namespace limn::test {
namespace {

constexpr int kSide = 128;
using Depths = std::vector<float>;

/// Draws pictures of clipped models and gives the depths, 1 where there is nothing.
class ClipInteriorTest : public DrawingTest {
 protected:
  Depths depths(ClipModel& model, const Camera& camera, const InteriorOptions& interior) {
    const auto targets = RenderTargets::create(kSide, kSide, 1, RenderTargets::Stencil::kEightBits);
    EXPECT_TRUE(targets);
    auto frame = ClipFrame::create(*context_);
    EXPECT_TRUE(frame);
    ClipDrawOptions options;
    options.level_tolerance_px = 0;
    options.interior = interior;
    frame->begin(*targets, camera, options);
    EXPECT_TRUE(frame->draw(model));
    frame->end();
    return read(*targets);
  }

  Depths depths_of_mesh(const Mesh& mesh, const Camera& camera) {
    ClipAsset itself = asset_of(mesh, mesh);  // a hull that is the original
    auto model = ClipModel::create(*context_, itself);
    EXPECT_TRUE(model);
    return depths(*model, camera, {.way = ClipInterior::kHull});
  }

  static Depths read(const RenderTargets& targets) {
    Depths z(static_cast<std::size_t>(kSide) * kSide);
    glGetTextureImage(targets.depth().id(), 0, GL_DEPTH_COMPONENT, GL_FLOAT, static_cast<GLsizei>(4 * z.size()),
                      z.data());
    return z;
  }

  static double distance_of(float z, const Camera& camera) {
    const double n = double{camera.near_distance}, f = double{camera.far_distance};
    return 2 * n * f / (f + n - (2.0 * double{z} - 1.0) * (f - n));
  }

  /// The share of the pixels that both cover whose distances are further apart than `apart`.
  static double wrong_share(const Depths& a, const Depths& b, const Camera& camera, double apart) {
    std::size_t both = 0, wrong = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      if (a[i] >= 1.0f || b[i] >= 1.0f) continue;
      ++both;
      wrong += std::abs(distance_of(a[i], camera) - distance_of(b[i], camera)) > apart ? 1 : 0;
    }
    return static_cast<double>(wrong) / static_cast<double>(std::max<std::size_t>(both, 1));
  }

  static std::size_t count_covered_otherwise(const Depths& a, const Depths& b) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
      count += (a[i] < 1.0f) != (b[i] < 1.0f) ? 1 : 0;
    return count;
  }
};

Camera camera_at(const Mesh& mesh, const Vec3& direction) {
  Camera camera = fit_camera(face_bounds(mesh), direction);
  camera.near_distance *= 0.7f;
  camera.far_distance *= 1.2f;
  return camera;
}

Result<BuiltClipAsset> built(const Mesh& mesh, std::size_t faces) {
  return build_clip_asset(mesh, {.faces = faces, .levels = 1, .size_px = 512});
}

TEST(HullShell, KnowsTheFaceBeyondEachEdge) {
  Mesh mesh = shape(Shape::kIcosphere, 80);
  mesh.normals = {mesh.positions, {}};
  mesh.uvs = {std::vector<Vec2>(mesh.positions.size(), Vec2(0.25f, 0.75f)), {}};
  const std::vector<ShellFace> faces = shell_faces(mesh);
  ASSERT_EQ(faces.size(), mesh.face_count());
  for (std::size_t f = 0; f < faces.size(); ++f) {
    EXPECT_FLOAT_EQ(faces[f].corner[0].w, 0.25f);
    EXPECT_FLOAT_EQ(faces[f].direction[0].w, 0.25f) << "v runs downwards";
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t other = faces[f].across[c] / 4, edge = faces[f].across[c] % 4;
      ASSERT_LT(other, faces.size());
      EXPECT_EQ(faces[other].across[edge], 4 * f + c) << "there and back";
      EXPECT_EQ(Vec3(faces[other].corner[edge]), Vec3(faces[f].corner[(c + 1) % 3])) << "the other way along the edge";
    }
  }
}

TEST_F(ClipInteriorTest, ShowsTheOriginalsLayersWhereTheHullDoesNot) {
  const Mesh knot = shape(Shape::kKnot, 20000);
  const auto asset = built(knot, 400);
  ASSERT_TRUE(asset);
  auto model = ClipModel::create(*context_, asset->asset);
  ASSERT_TRUE(model);
  double hull = 0, march = 0;
  for (const Vec3& direction : {Vec3(0, 0, 1), Vec3(0.6f, 0, 0.8f), Vec3(0, 0.8f, 0.6f), Vec3(0.48f, 0.6f, 0.64f)}) {
    const Camera camera = camera_at(knot, direction);
    const Depths truth = depths_of_mesh(knot, camera);
    const Depths as_hull = depths(*model, camera, {.way = ClipInterior::kHull});
    const Depths marched = depths(*model, camera, {.way = ClipInterior::kMarch});
    const double apart = 0.02 * face_bounds(knot).diagonal();
    hull += wrong_share(truth, as_hull, camera, apart);
    march += wrong_share(truth, marched, camera, apart);
    EXPECT_EQ(count_covered_otherwise(truth, marched), 0u) << "every pixel of the stencil is drawn";
  }
  EXPECT_GT(hull, 4 * 0.01) << "a hull that is wrong nowhere shows nothing";
  EXPECT_LT(march, 0.25 * hull);
}

TEST_F(ClipInteriorTest, FindsTheSurfaceWhereTheHullIsFarOff) {
  // A hull that stands off by a third of the radius: without following the line of sight depths are off by much.
  const Mesh sphere = shape(Shape::kIcosphere, 20480);
  Mesh hull = shape(Shape::kIcosphere, 80);
  hull.normals = {hull.positions, {}};
  for (Vec3& p : hull.positions)
    p *= 1.35f;
  BakeOptions options;
  options.maps.displacement = true;
  options.layout = BakeLayout::kTiles;
  options.size_px = 512;
  const auto baked = bake(sphere, hull, options);
  ASSERT_TRUE(baked);
  ClipAsset asset = asset_of(sphere, baked->mesh);
  asset.maps.normals = Image(512, 512);
  asset.maps.displacement_width = asset.maps.displacement_height = 512;
  asset.maps.displacement_low = static_cast<float>(baked->report.displacement_low);
  for (const float d : baked->displacement.values)
    asset.maps.displacement.push_back(
        static_cast<std::uint16_t>(std::lround(65535.0f * (1.0f - d / asset.maps.displacement_low))));
  auto model = ClipModel::create(*context_, asset);
  ASSERT_TRUE(model);
  const Camera camera = camera_at(sphere, Vec3(0, 0, 1));
  const Depths truth = depths_of_mesh(sphere, camera);
  EXPECT_GT(wrong_share(truth, depths(*model, camera, {.way = ClipInterior::kHull}), camera, 0.01), 0.3);
  EXPECT_LT(wrong_share(truth, depths(*model, camera, {}), camera, 0.01), 0.03);
}

TEST_F(ClipInteriorTest, IsTheHullWhereMapsAreMissing) {
  const Mesh knot = shape(Shape::kKnot, 5000);
  auto asset = built(knot, 300);
  ASSERT_TRUE(asset);
  asset->asset.maps.displacement.clear();
  auto model = ClipModel::create(*context_, asset->asset);
  ASSERT_TRUE(model);
  const Camera camera = camera_at(knot, Vec3(0, 0, 1));
  EXPECT_EQ(depths(*model, camera, {.way = ClipInterior::kMarch}),
            depths(*model, camera, {.way = ClipInterior::kHull}));
}

TEST_F(ClipInteriorTest, LeavesNothingBehindForTheNextModel) {
  const Mesh knot = shape(Shape::kKnot, 5000);
  const auto asset = built(knot, 300);
  ASSERT_TRUE(asset);
  auto model = ClipModel::create(*context_, asset->asset);
  ASSERT_TRUE(model);
  const Camera camera = camera_at(knot, Vec3(0, 0, 1));
  RenderOptions options;
  options.width = options.height = kSide;
  options.samples = 1;
  const ClipInstance once{&*model, Mat4(1.0f)};
  const ClipInstance twice[] = {once, once};
  const auto one = render_clipped(*context_, std::span(&once, 1), camera, options);
  const auto two = render_clipped(*context_, twice, camera, options);
  ASSERT_TRUE(one && two);
  EXPECT_EQ(one->image.rgba, two->image.rgba);
}

}  // namespace
}  // namespace limn::test
