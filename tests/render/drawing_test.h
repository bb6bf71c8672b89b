#pragma once

#include <gtest/gtest.h>
#include <memory>

#include "limn/render/render.h"

#include "support/temp_folder.h"

namespace limn::test {

/// A test that draws: a context of its own, and no severe message from the driver allowed.
class DrawingTest : public testing::Test {
 protected:
  void SetUp() override {
    auto context = gl::Context::create();
    ASSERT_TRUE(context) << format_error(context.error());
    context_ = std::move(*context);
  }
  void TearDown() override {
    if (context_) {
      EXPECT_EQ(context_->severe_messages(), 0) << context_->last_severe_message();
    }
  }

  /// The picture; an empty one, and a failed test, when there is none.
  Image draw(const Mesh& mesh, const Camera& camera, const RenderOptions& options,
             std::span<const Segment3> segments = {}) {
    auto image = render(*context_, mesh, camera, options, segments);
    EXPECT_TRUE(image) << format_error(image.error());
    return image ? std::move(*image) : Image(options.width, options.height);
  }

  std::unique_ptr<gl::Context> context_;
};

/// Looks down the z axis from above so that a unit is a pixel: x and y of a point are its place in the picture, y
/// upwards.
inline Camera pixel_camera(int width, int height) {
  Camera camera;
  const Vec3 middle(0.5f * static_cast<float>(width), 0.5f * static_cast<float>(height), 0.0f);
  camera.eye = middle + Vec3(0, 0, 10);
  camera.target = middle;
  camera.orthographic = true;
  camera.ortho_height = static_cast<float>(height);
  camera.near_distance = 1.0f;
  camera.far_distance = 20.0f;
  return camera;
}

inline RenderOptions picture_options(int width, int height, int samples, const Vec4& background) {
  RenderOptions options;
  options.width = width;
  options.height = height;
  options.samples = samples;
  options.background = background;
  return options;
}

constexpr Vec4 kTransparent(0, 0, 0, 0);
constexpr Vec4 kWhite(1, 1, 1, 1);

/// A rectangle that faces +z at height z, two triangles, texture coordinates over all of it.
inline Mesh rectangle(const Vec2& low, const Vec2& high, float z = 0.0f) {
  Mesh mesh;
  mesh.positions = {Vec3(low, z), Vec3(high.x, low.y, z), Vec3(high, z), Vec3(low.x, high.y, z)};
  mesh.uvs.values = {Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1)};
  mesh.faces = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

inline void append(Mesh& mesh, const Mesh& other) {
  const auto first = static_cast<VertexId>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
  mesh.uvs.values.insert(mesh.uvs.values.end(), other.uvs.values.begin(), other.uvs.values.end());
  for (const Triangle& face : other.faces)
    mesh.faces.push_back({face[0] + first, face[1] + first, face[2] + first});
}

/// The picture as an encoded file, as materials hold it.
inline std::vector<std::byte> png_of(const Image& image) {
  const TempFolder folder;
  EXPECT_TRUE(write_png(image, folder / "texture.png"));
  const std::string bytes = slurp(folder / "texture.png");
  const auto view = std::as_bytes(std::span(bytes.data(), bytes.size()));
  return {view.begin(), view.end()};
}

}  // namespace limn::test
