#include "limn/base/camera.h"

#include <algorithm>
#include <glm/common.hpp>
#include <gtest/gtest.h>
#include <vector>

#include "limn/base/random.h"

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

TEST(FitCamera, FillsThePictureWithThePointsThemselves) {
  Random random(1);
  for (int n = 0; n < 200; ++n) {
    std::vector<Vec3> points;
    for (int i = 0; i < 30; ++i)
      points.push_back(random.direction() * Vec3(3, 1, 0.5f) + Vec3(10, -4, 2));
    const CameraFit fit{.orthographic = n % 2 == 0, .fill = 0.8f, .aspect = n % 3 == 0 ? 0.6f : 1.7f};
    const Camera camera = fit_camera(points, random.direction(), fit);
    const Mat4 clip_from_world = projection_matrix(camera, fit.aspect) * view_matrix(camera);
    Vec2 low(9), high(-9);
    for (const Vec3& p : points) {
      const Vec4 clip = clip_from_world * Vec4(p, 1);
      low = glm::min(low, Vec2(clip) / clip.w);
      high = glm::max(high, Vec2(clip) / clip.w);
      EXPECT_LE(std::abs(clip.z / clip.w), 1.0f);
    }
    EXPECT_NEAR(std::max({-low.x, -low.y, high.x, high.y}), 0.8f, 1e-3f);
    const Vec2 middle = low + high;
    if (fit.orthographic) {
      EXPECT_NEAR(middle.x, 0.0f, 1e-3f);
      EXPECT_NEAR(middle.y, 0.0f, 1e-3f);
    }
  }
}

TEST(FitCamera, TakesASinglePointToo) {
  const Vec3 point(1, 2, 3);
  for (const bool orthographic : {false, true}) {
    const Camera camera = fit_camera(std::span(&point, 1), Vec3(0, 0, 1), {.orthographic = orthographic});
    EXPECT_TRUE(is_finite(camera.eye));
    EXPECT_NE(camera.eye, camera.target);
    EXPECT_GT(camera.far_distance, camera.near_distance);
    EXPECT_GT(camera.ortho_height, 0.0f);
  }
}

}  // namespace
}  // namespace limn
