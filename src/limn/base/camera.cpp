#include "limn/base/camera.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>

namespace limn {

Mat4 view_matrix(const Camera& camera) {
  const Vec3 forward = glm::normalize(camera.target - camera.eye);
  Vec3 up = camera.up;
  const float up_length = glm::length(up);
  if (up_length == 0.0f || std::abs(glm::dot(forward, up)) > 0.9999f * up_length) {
    up = std::abs(forward.y) > 0.9f ? Vec3(0, 0, forward.y > 0 ? 1 : -1) : Vec3(0, 1, 0);
  }
  return glm::lookAt(camera.eye, camera.target, up);
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
  const float c = std::cos(elevation_rad);
  return fit_camera(bounds, Vec3(c * std::sin(azimuth_rad), std::sin(elevation_rad), c * std::cos(azimuth_rad)), fit);
}

}  // namespace limn
