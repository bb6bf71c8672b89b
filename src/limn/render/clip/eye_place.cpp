#include "limn/render/clip/eye_place.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

namespace limn {
namespace {

constexpr int kDirections = 122;
constexpr double kGoldenAngle = 2.399963229728653;

/// Directions spread evenly over the sphere.
std::vector<Vec3> even_directions() {
  std::vector<Vec3> directions;
  for (int i = 0; i < kDirections; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / kDirections, r = std::sqrt(1.0 - z * z);
    directions.emplace_back(r * std::cos(kGoldenAngle * i), r * std::sin(kGoldenAngle * i), z);
  }
  for (int axis = 0; axis < 6; ++axis) {
    Vec3 direction(0);
    direction[axis / 2] = axis % 2 == 0 ? 1.0f : -1.0f;
    directions.push_back(direction);
  }
  return directions;
}

/// Twice the solid angle's half, signed: van Oosterom and Strackee.
double solid_angle(const DVec3& a, const DVec3& b, const DVec3& c) {
  const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
  const double below = la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb;
  return 2.0 * std::atan2(glm::dot(a, glm::cross(b, c)), below);
}

/// Planes, positive inside, around all that lies in the picture but nearer than the near plane.
std::vector<Vec4> near_region(const CameraBlock& camera) {
  const float height = 0.5f * camera.pixel_size * camera.size_px.y, width = 0.5f * camera.pixel_size * camera.size_px.x;
  if (camera.orthographic != 0)
    return {
        {1, 0, 0, width}, {-1, 0, 0, width}, {0, 1, 0, height}, {0, -1, 0, height}, {0, 0, 1, camera.near_distance}};
  return {
      {1, 0, -width, 0}, {-1, 0, -width, 0}, {0, 1, -height, 0}, {0, -1, -height, 0}, {0, 0, 1, camera.near_distance}};
}

}  // namespace

EyeLocator::EyeLocator(const Mesh& surface, const Bounds& model)
    : positions_(surface.positions), faces_(surface.faces), directions_(even_directions()), model_(model) {
  const Bounds bounds = face_bounds(surface);
  center_ = bounds.empty() ? Vec3(0) : bounds.center();
  for (const Triangle& face : faces_) {
    for (const VertexId v : face)
      radius_ = std::max(radius_, static_cast<float>(1.000001 * glm::length(DVec3(positions_[v]) - DVec3(center_))));
  }
  for (const Vec3& direction : directions_) {
    float highest = -radius_;
    for (const Triangle& face : faces_) {
      for (const VertexId v : face)
        highest = std::max(highest, glm::dot(direction, positions_[v] - center_));
    }
    highest_.push_back(highest + 1e-5f * radius_);
  }
}

bool EyeLocator::outside_convex_hull(const Vec3& eye) const {
  for (std::size_t i = 0; i < directions_.size(); ++i) {
    if (glm::dot(directions_[i], eye - center_) > highest_[i]) return true;
  }
  return false;
}

bool EyeLocator::inside(const Vec3& eye) const {
  double sum = 0;
  for (const Triangle& face : faces_) {
    sum += solid_angle(DVec3(positions_[face[0]]) - DVec3(eye), DVec3(positions_[face[1]]) - DVec3(eye),
                       DVec3(positions_[face[2]]) - DVec3(eye));
  }
  return std::abs(sum) > 2.0 * 3.14159265358979;  // half a turn of 4 pi
}

/// What of the hull alone is too near or too far does not matter: depths are clamped, not cut.
bool EyeLocator::model_is_between(const CameraBlock& camera, float far_distance, const Mat4& model_to_eye) const {
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p((corner & 1) != 0 ? model_.high.x : model_.low.x, (corner & 2) != 0 ? model_.high.y : model_.low.y,
                 (corner & 4) != 0 ? model_.high.z : model_.low.z);
    const float depth = -(model_to_eye * Vec4(p, 1.0f)).z;
    if (!(depth > camera.near_distance * 1.00001f && depth < far_distance * 0.99999f)) return false;
  }
  return true;
}

bool EyeLocator::is_cut(const CameraBlock& camera, float far_distance, const Mat4& model_to_eye) const {
  if (model_is_between(camera, far_distance, model_to_eye)) return false;
  const float reach = glm::length(Vec3(model_to_eye[0])) * radius_ * 1.0001f;
  const std::vector<Vec4> planes = near_region(camera);
  for (const Triangle& face : faces_) {
    std::array<Vec4, 3> p;
    for (std::size_t c = 0; c < 3; ++c) {
      p[c] = model_to_eye * Vec4(positions_[face[c]], 1.0f);
      if (-p[c].z > far_distance) return true;
    }
    const auto misses = [&](const Vec4& plane) {
      const float slack = -1e-5f * reach;
      return glm::dot(plane, p[0]) < slack && glm::dot(plane, p[1]) < slack && glm::dot(plane, p[2]) < slack;
    };
    if (std::none_of(planes.begin(), planes.end(), misses)) return true;
  }
  return false;
}

EyePlace EyeLocator::place(const CameraBlock& camera, float far_distance, const Mat4& model_to_eye,
                           const Vec3& eye) const {
  if (is_cut(camera, far_distance, model_to_eye)) return EyePlace::kInside;
  if (camera.orthographic != 0 || outside_convex_hull(eye)) return EyePlace::kOutside;
  return inside(eye) ? EyePlace::kInside : EyePlace::kBetween;
}

}  // namespace limn
