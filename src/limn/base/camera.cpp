#include "limn/base/camera.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace limn {

Mat4 view_matrix(const Camera& camera) {
  // In double: the squares of a large model's coordinates are beyond float.
  const DVec3 eye = camera.eye;
  const DVec3 forward = glm::normalize(DVec3(camera.target) - eye);
  DVec3 up = camera.up;
  const double up_length = glm::length(up);
  if (up_length == 0.0 || std::abs(glm::dot(forward, up)) > 0.9999 * up_length) {
    up = std::abs(forward.y) > 0.9 ? DVec3(0, 0, forward.y > 0 ? 1 : -1) : DVec3(0, 1, 0);
  }
  return Mat4(glm::lookAt(eye, eye + forward * std::max(1.0, glm::length(eye)), up));
}

Mat4 projection_matrix(const Camera& camera, float aspect) {
  assert(aspect > 0.0f);
  if (camera.orthographic) {
    const float half_height = camera.ortho_height * 0.5f;
    return glm::ortho(-half_height * aspect, half_height * aspect, -half_height, half_height, camera.near_distance,
                      camera.far_distance);
  }
  return glm::perspective(camera.fov_rad, aspect, camera.near_distance, camera.far_distance);
}

Camera fit_camera(const Bounds& bounds, const Vec3& direction, const CameraFit& fit) {
  assert(!bounds.empty());
  const double diagonal = bounds.diagonal();
  const double radius = 0.5 * (diagonal > 0.0 ? diagonal : 1.0);
  const double smaller_side = std::min(1.0, static_cast<double>(fit.aspect));  // in units of the height
  Camera camera;
  camera.target = bounds.center();
  camera.orthographic = fit.orthographic;
  camera.fov_rad = fit.fov_rad;
  camera.ortho_height = static_cast<float>(2.0 * radius / (fit.fill * smaller_side));
  // Perspective: the sphere's outline, not its equator, has to span the wanted share of the picture.
  const double half_extent = std::tan(0.5 * fit.fov_rad) * fit.fill * smaller_side;
  const double distance = fit.orthographic ? 3.0 * radius : radius / std::sin(std::atan(half_extent));
  camera.eye = Vec3(DVec3(camera.target) + DVec3(direction) * distance);
  camera.near_distance = static_cast<float>(std::max(distance - 1.01 * radius, 1e-3 * distance));
  camera.far_distance = static_cast<float>(distance + 1.01 * radius);
  return camera;
}

Camera fit_camera(const Bounds& bounds, float azimuth_rad, float elevation_rad, const CameraFit& fit) {
  return fit_camera(bounds, view_direction(azimuth_rad, elevation_rad), fit);
}

Vec3 view_direction(float azimuth_rad, float elevation_rad) {
  const float c = std::cos(elevation_rad);
  return {c * std::sin(azimuth_rad), std::sin(elevation_rad), c * std::cos(azimuth_rad)};
}

Camera fit_camera(std::span<const Vec3> points, const Vec3& direction, const CameraFit& fit) {
  assert(!points.empty());
  const Bounds bounds = bounds_of(points);
  Camera camera = fit_camera(bounds, direction, fit);
  const double diagonal = bounds.diagonal();
  const double radius = 0.5 * (diagonal > 0.0 ? diagonal : 1.0);
  const DVec3 middle = bounds.center();
  const glm::dmat3 axes = glm::transpose(glm::dmat3(view_matrix(camera)));  // columns: right, up, towards the viewer
  const double half_height = fit.orthographic ? 1.0 : std::tan(0.5 * fit.fov_rad) * fit.fill;
  // Points against the planes of the view's pyramid, whose sides lean by `lean` a unit of depth: a parallel one's by 0.
  const double lean[2] = {fit.orthographic ? 0.0 : half_height * fit.aspect, fit.orthographic ? 0.0 : half_height};
  double low[2] = {HUGE_VAL, HUGE_VAL};
  double high[2] = {-HUGE_VAL, -HUGE_VAL};
  double nearest = -HUGE_VAL;
  double farthest = HUGE_VAL;
  for (const Vec3& point : points) {
    const DVec3 p = DVec3(point) - middle;
    const double depth = glm::dot(p, axes[2]);
    nearest = std::max(nearest, depth);
    farthest = std::min(farthest, depth);
    for (int axis = 0; axis < 2; ++axis) {
      const double across = glm::dot(p, axes[axis]);
      high[axis] = std::max(high[axis], across + lean[axis] * depth);
      low[axis] = std::min(low[axis], across - lean[axis] * depth);
    }
  }
  const double width = high[0] - low[0];
  const double height = high[1] - low[1];
  double distance = nearest + 2.0 * radius;
  if (fit.orthographic) {
    camera.ortho_height =
        static_cast<float>(std::max({height, width / double{fit.aspect}, 1e-3 * radius}) / double{fit.fill});
  } else {
    distance = std::max({0.5 * width / lean[0], 0.5 * height / lean[1], nearest + 1e-2 * radius});
  }
  const DVec3 shift = axes[0] * (0.5 * (low[0] + high[0])) + axes[1] * (0.5 * (low[1] + high[1]));
  camera.target = Vec3(middle + shift);
  camera.eye = Vec3(middle + shift + axes[2] * distance);
  camera.near_distance = static_cast<float>(std::max(distance - nearest - 0.01 * radius, 1e-3 * distance));
  camera.far_distance = static_cast<float>(distance - farthest + 0.01 * radius);
  return camera;
}

}  // namespace limn
