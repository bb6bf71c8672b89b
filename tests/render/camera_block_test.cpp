#include "limn/render/camera_block.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace limn {
namespace {

TEST(CameraBlock, TakesPointsWhereTheViewMatrixTakesThem) {
  Camera camera;
  camera.eye = Vec3(1, 2, 5);
  camera.target = Vec3(0.25f, -0.5f, 0);
  const CameraBlock block = make_camera_block(camera, 640, 480);
  const Vec3 p(0.3f, 0.7f, -0.2f);
  const Vec4 expected = projection_matrix(camera, 640.0f / 480.0f) * view_matrix(camera) * Vec4(p, 1.0f);
  const Vec4 clip = block.projection * Vec4(Vec3(block.rotation * Vec4(p - block.eye, 0.0f)), 1.0f);
  EXPECT_LT(glm::length(clip - expected), 1e-5f);
  EXPECT_LT(glm::length(block.inverse_projection * clip / (block.inverse_projection * clip).w -
                        view_matrix(camera) * Vec4(p, 1.0f)),
            1e-4f);
  EXPECT_LT(glm::length(block.world_up - Vec3(view_matrix(camera) * Vec4(0, 1, 0, 0))), 1e-6f);
  EXPECT_EQ(block.size_px, Vec2(640, 480));
}

TEST(CameraBlock, SaysHowLargeAPixelIs) {
  Camera camera;
  camera.orthographic = true;
  camera.ortho_height = 24.0f;
  EXPECT_EQ(make_camera_block(camera, 100, 48).pixel_size, 0.5f);
  EXPECT_EQ(make_camera_block(camera, 100, 48).orthographic, 1);
  camera.orthographic = false;
  camera.fov_rad = 2.0f * std::atan(0.5f);
  EXPECT_NEAR(make_camera_block(camera, 100, 50).pixel_size, 0.02f, 1e-6f);
}

}  // namespace
}  // namespace limn
