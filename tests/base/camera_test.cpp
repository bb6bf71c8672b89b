#include "limn/base/camera.h"

#include <gtest/gtest.h>

namespace limn {
namespace {

TEST(FitCamera, FramesTheDiagonalOfABoxInBothProjections) {
  Bounds bounds;
  bounds.add(Vec3(-1, -2, 3));
  bounds.add(Vec3(4, 2, 5));
  for (const bool orthographic : {false, true}) {
    const Camera camera = fit_camera(bounds, 0.7f, 0.3f, {.orthographic = orthographic, .fill = 0.8f, .aspect = 1.5f});
    const Mat4 clip_from_world = projection_matrix(camera, 1.5f) * view_matrix(camera);
    const Vec4 center = clip_from_world * Vec4(bounds.center(), 1);
    EXPECT_NEAR(center.x / center.w, 0, 1e-5);
    EXPECT_NEAR(center.y / center.w, 0, 1e-5);
    for (int i = 0; i < 8; ++i) {
      const Vec4 corner =
          clip_from_world * Vec4(i & 1 ? bounds.high.x : bounds.low.x, i & 2 ? bounds.high.y : bounds.low.y,
                                 i & 4 ? bounds.high.z : bounds.low.z, 1);
      EXPECT_LE(std::abs(corner.y / corner.w), 0.8001f);
      EXPECT_LE(std::abs(corner.z / corner.w), 1.0f);
    }
  }
}

TEST(FitCamera, LooksFromTheAskedSide) {
  Bounds bounds;
  bounds.add(Vec3(-1));
  bounds.add(Vec3(1));
  EXPECT_GT(fit_camera(bounds, 0.0f, 0.0f).eye.z, 1.0f);
  EXPECT_GT(fit_camera(bounds, 1.5707963f, 0.0f).eye.x, 1.0f);
  const Camera above = fit_camera(bounds, 0.0f, 1.5707963f);
  EXPECT_GT(above.eye.y, 1.0f);
  const Vec4 center = view_matrix(above) * Vec4(0, 0, 0, 1);
  EXPECT_TRUE(is_finite(Vec3(center)));
}

}  // namespace
}  // namespace limn
