// Several clipped models and ordinary geometry in one picture, soft outlines, levels, replaced shading.
#include <epoxy/gl.h>
#include <glm/ext/matrix_transform.hpp>

#include "limn/base/random.h"
#include "limn/render/clip/clip_picture.h"
#include "limn/render/gpu_mesh.h"

#include "clip_bodies.h"

namespace limn {
namespace {

using test::asset_of;
using test::kTransparent;
using test::kWhite;
using test::picture_options;

class ClipScene : public test::DrawingTest {
 protected:
  ClipModel model_of(const ClipAsset& asset) {
    auto model = ClipModel::create(*context_, asset);
    EXPECT_TRUE(model) << format_error(model.error());
    return std::move(*model);
  }
  ClipPicture clip(std::span<const ClipInstance> instances, const Camera& camera, const RenderOptions& options,
                   const ClipDrawOptions& drawing = {}) {
    auto picture = render_clipped(*context_, instances, camera, options, drawing);
    EXPECT_TRUE(picture) << format_error(picture.error());
    return picture ? std::move(*picture)
                   : ClipPicture{Image(options.width, options.height), std::vector<ClipDrawn>(instances.size()), 0};
  }
};

Camera scene_camera() {
  Camera camera;
  camera.eye = Vec3(0.4f, 0.7f, 6.0f);
  camera.near_distance = 1.0f;
  camera.far_distance = 20.0f;
  return camera;
}

Mesh colored(Mesh mesh, const Vec3& color) {
  Material material;
  material.base_color = Vec4(color, 1.0f);
  mesh.uvs = {};
  mesh.materials = {material};
  mesh.face_materials.clear();
  return mesh;
}

/// Its points and faces alone, moved.
Mesh moved(const Mesh& original, const Mat4& to_world) {
  Mesh mesh;
  mesh.positions = original.positions;
  mesh.faces = original.faces;
  for (Vec3& p : mesh.positions)
    p = Vec3(to_world * Vec4(p, 1.0f));
  return mesh;
}

/// Tight hulls: spheres a hundredth larger, so that hull and original agree on who is in front.
ClipAsset sphere_asset(const Vec3& color) {
  const Mesh fine = test::shape(Shape::kIcosphere, 5120);
  Mesh hull = colored(test::shape(Shape::kIcosphere, 1280), color);
  for (Vec3& p : hull.positions)
    p *= 1.02f;
  return asset_of(fine, hull);
}

bool is_red(const std::uint8_t* pixel) {
  return pixel[0] > pixel[1] + 20;
}

TEST_F(ClipScene, TheNearerOfTwoModelsIsSeenWhateverTheOrder) {
  ClipModel red = model_of(sphere_asset(Vec3(0.8f, 0.05f, 0.05f))),
            green = model_of(sphere_asset(Vec3(0.05f, 0.8f, 0.05f)));
  const Mat4 near = glm::translate(Mat4(1.0f), Vec3(-0.4f, 0.0f, 1.5f)),
             far = glm::translate(Mat4(1.0f), Vec3(0.5f, 0.2f, -1.5f));
  const ClipInstance there[] = {{&red, near}, {&green, far}}, back[] = {{&green, far}, {&red, near}};
  const RenderOptions options = picture_options(256, 256, 1, kTransparent);
  const Image first = clip(there, scene_camera(), options).image, second = clip(back, scene_camera(), options).image;
  EXPECT_EQ(first.rgba, second.rgba);
  // What covers is what the two spheres cover, and the near one is whole.
  Mesh both = moved(test::shape(Shape::kIcosphere, 5120), near);
  const Image near_only = draw(both, scene_camera(), options);
  test::append(both, moved(test::shape(Shape::kIcosphere, 5120), far));
  EXPECT_LE(test::count_differing(first, draw(both, scene_camera(), options)), 2u);  // places rounded twice
  std::size_t hidden = 0;
  for (int y = 0; y < 256; ++y) {
    for (int x = 0; x < 256; ++x)
      hidden += near_only.pixel(x, y)[3] > 0 && !is_red(first.pixel(x, y)) ? 1 : 0;
  }
  EXPECT_LE(hidden, 2u);
}

TEST_F(ClipScene, OneModelManyTimesTurnedAndScaled) {
  const Mesh knot = test::shape(Shape::kKnot, 20000);
  ClipModel model = model_of(asset_of(knot));
  Random random(5);
  std::vector<ClipInstance> instances;
  Mesh all;
  for (int i = 0; i < 5; ++i) {
    Mat4 place = glm::translate(Mat4(1.0f), 1.5f * random.direction());
    place = glm::rotate(place, 1.3f * static_cast<float>(i), random.direction());
    place = glm::scale(place, Vec3(0.4f + 0.1f * static_cast<float>(i)));
    instances.push_back({&model, place});
    test::append(all, moved(knot, place));
  }
  const RenderOptions options = picture_options(300, 300, 1, kTransparent);
  const ClipPicture picture = clip(instances, scene_camera(), options);
  for (const ClipDrawn& drawn : picture.drawn)
    EXPECT_EQ(drawn.place, EyePlace::kOutside);
  EXPECT_LE(test::count_differing(picture.image, draw(all, scene_camera(), options)), 3u);  // places rounded twice
}

/// An ordinary wall through a clipped sphere's middle hides its far half alone.
TEST_F(ClipScene, OrdinaryGeometryHidesAndIsHidden) {
  ClipModel sphere = model_of(sphere_asset(Vec3(0.8f, 0.05f, 0.05f)));
  const auto targets = RenderTargets::create(200, 200, 1, RenderTargets::Stencil::kEightBits);
  auto frame = ClipFrame::create(*context_);
  ASSERT_TRUE(targets && frame);
  const Mesh wall = colored(test::rectangle(Vec2(-3), Vec2(3), 0.3f), Vec3(0.05f, 0.05f, 0.8f));
  const auto gpu = GpuMesh::upload(wall, wall.positions);
  const auto materials = MaterialTable::create(wall);
  const auto program = context_->program({"face.vert.glsl", "", "face.frag.glsl", {}});
  ASSERT_TRUE(gpu && materials && program);
  const auto draw_wall = [&] {
    (*program)->use();
    (*program)->set("flat_normals", 1);
    materials->bind();
    glVertexAttrib4f(3, 1.0f, 1.0f, 1.0f, 1.0f);
    gpu->draw();
  };
  std::vector<Image> pictures;
  for (const bool wall_first : {true, false}) {
    frame->begin(*targets, scene_camera());
    if (wall_first) draw_wall();
    ASSERT_TRUE(frame->draw(sphere));
    if (!wall_first) draw_wall();
    frame->end();
    auto image = targets->resolve(*context_, kWhite);
    ASSERT_TRUE(image);
    pictures.push_back(std::move(*image));
  }
  EXPECT_EQ(pictures[0].rgba, pictures[1].rgba);
  std::size_t red = 0, blue = 0;
  for (int y = 0; y < 200; ++y) {
    for (int x = 0; x < 200; ++x) {
      red += is_red(pictures[0].pixel(x, y)) ? 1 : 0;
      blue += pictures[0].pixel(x, y)[2] > pictures[0].pixel(x, y)[0] + 20 ? 1 : 0;
    }
  }
  EXPECT_GT(red, 1000u);
  EXPECT_GT(blue, red);
}

/// With the displacement a hull far outside has the original's depth.
TEST_F(ClipScene, ADisplacementMapGivesTheOriginalsDepth) {
  ClipAsset asset = sphere_asset(Vec3(0.8f, 0.05f, 0.05f));
  for (Vec3& p : asset.hull.positions)
    p *= 1.5f / 1.02f;
  asset.hull.normals.values = asset.hull.positions;
  for (Vec3& n : asset.hull.normals.values)
    n = glm::normalize(n);
  asset.hull.normals.indices.clear();
  asset.hull.uvs.values.assign(asset.hull.positions.size(), Vec2(0.5f));
  ClipModel hull_depth = model_of(asset);
  asset.maps.displacement.assign(16, 0);
  asset.maps.displacement_width = asset.maps.displacement_height = 4;
  asset.maps.displacement_low = -0.5f;
  ClipModel own_depth = model_of(asset);
  // Another sphere, whose front lies between the two depths.
  ClipModel other = model_of(sphere_asset(Vec3(0.05f, 0.8f, 0.05f)));
  const Mat4 place = glm::translate(Mat4(1.0f), Vec3(0.0f, 0.0f, 0.2f));
  const RenderOptions options = picture_options(128, 128, 1, kTransparent);
  const auto red_in_the_middle = [&](ClipModel& model) {
    const ClipInstance two[] = {{&model, Mat4(1.0f)}, {&other, place}};
    const Image image = clip(two, scene_camera(), options).image;
    return is_red(image.pixel(64, 64));
  };
  EXPECT_TRUE(red_in_the_middle(hull_depth));
  EXPECT_FALSE(red_in_the_middle(own_depth));
}

TEST_F(ClipScene, LinesSmoothTheOutlineAndLeaveTheInsideAlone) {
  const Mesh knot = test::shape(Shape::kKnot, 20000);
  ClipModel model = model_of(asset_of(knot));
  const Camera camera = scene_camera();
  const ClipInstance instance{&model, Mat4(1.0f)};
  const RenderOptions options = picture_options(200, 200, 1, kWhite);
  ClipDrawOptions lines;
  lines.antialias = ClipAntialias::kLines;
  const Image hard = clip(std::span(&instance, 1), camera, options).image;
  const Image soft = clip(std::span(&instance, 1), camera, options, lines).image;
  const Image covered = clip(std::span(&instance, 1), camera, picture_options(200, 200, 1, kTransparent)).image;
  std::size_t rim = 0;
  for (int y = 1; y < 199; ++y) {
    for (int x = 1; x < 199; ++x) {
      const bool inside = covered.pixel(x, y)[3] > 0;
      bool near = false;
      for (int d = 0; d < 9; ++d)
        near = near || covered.pixel(x + d % 3 - 1, y + d / 3 - 1)[3] > 0;
      const std::uint8_t* const pixel = soft.pixel(x, y);
      if (inside) {
        ASSERT_EQ(pixel[0], hard.pixel(x, y)[0]) << x << ", " << y;
      } else if (!near) {
        ASSERT_EQ(pixel[0], 255) << x << ", " << y;
      } else {
        rim += pixel[0] < 255 ? 1 : 0;
      }
      ASSERT_EQ(pixel[3], 255);
    }
  }
  EXPECT_GT(rim, 300u);
  const auto transparent =
      render_clipped(*context_, std::span(&instance, 1), camera, picture_options(64, 64, 1, kTransparent), lines);
  ASSERT_FALSE(transparent);
  EXPECT_EQ(transparent.error().code, ErrorCode::kInvalidArgument);
  EXPECT_FALSE(render_clipped(*context_, std::span(&instance, 1), camera, picture_options(64, 64, 4, kWhite), lines));
}

TEST_F(ClipScene, FartherModelsTakeCoarserSilhouettes) {
  ClipAsset asset = asset_of(test::shape(Shape::kIcosphere, 5120));
  asset.levels.push_back({test::shape(Shape::kIcosphere, 1280), 0.003f, {}});
  asset.levels.push_back({test::shape(Shape::kIcosphere, 320), 0.012f, {}});
  ClipModel model = model_of(asset);
  const ClipInstance instance{&model, Mat4(1.0f)};
  const auto level_at = [&](float distance, float tolerance_px) {
    Camera camera;
    camera.eye = Vec3(0, 0, distance);
    camera.near_distance = 0.5f;
    camera.far_distance = 2 * distance;
    ClipDrawOptions options;
    options.level_tolerance_px = tolerance_px;
    return clip(std::span(&instance, 1), camera, picture_options(512, 512, 1, kWhite), options).drawn.front().level;
  };
  EXPECT_EQ(level_at(4.0f, 0.25f), 0u);
  EXPECT_EQ(level_at(20.0f, 0.25f), 1u);
  EXPECT_EQ(level_at(90.0f, 0.25f), 2u);
  EXPECT_EQ(level_at(90.0f, 0.0f), 0u);
}

}  // namespace
}  // namespace limn
