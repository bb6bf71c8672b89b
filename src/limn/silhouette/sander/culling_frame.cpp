#include "limn/silhouette/sander/culling_frame.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "limn/base/bounds.h"

namespace limn {
namespace {

// Beyond these faces_eye() itself may overflow, or lose a direction to underflow.
constexpr double kFarthestEye = 1e37;
constexpr double kShortestDirection = 1e-30;

// Products of floats may underflow: half the smallest subnormal, three times, and a margin.
constexpr double kUnderflow = 5e-45;

bool is_finite(const Plane& plane) {
  return std::isfinite(plane.nx) && std::isfinite(plane.ny) && std::isfinite(plane.nz) && std::isfinite(plane.d);
}

}  // namespace

CullingFrame culling_frame(const Mesh& mesh, std::span<const Plane> planes) {
  Bounds bounds;
  for (const Triangle& face : mesh.faces) {
    for (const VertexId v : face)
      bounds.add(mesh.positions[v]);
  }
  CullingFrame frame;
  if (bounds.empty()) return frame;
  frame.center = (DVec3(bounds.low) + DVec3(bounds.high)) * 0.5;
  const double radius = bounds.diagonal() / 2;
  if (radius > 0.0) frame.per_unit = 1.0 / radius;
  double farthest = 0.0;
  for (const Plane& plane : planes) {
    if (is_finite(plane)) farthest = std::max(farthest, std::abs(double{plane.d}));
  }
  // |eye| outside the frame is at most |center| + radius·|eye| inside it.
  const double reach = farthest + glm::length(frame.center);
  frame.plane_error = (CullingFrame::kEyeError * reach + kUnderflow) * frame.per_unit;
  return frame;
}

FramedPlane framed_plane(const Plane& plane, const CullingFrame& frame) {
  const DVec3 n(plane.nx, plane.ny, plane.nz);
  const double length = glm::length(n);
  if (!is_finite(plane) || !(length > 0.0)) return {};
  return {n / length, (plane.d + glm::dot(n, frame.center)) * frame.per_unit / length, true};
}

FramedEye framed_eye(const Eye& eye, const CullingFrame& frame) {
  const DVec3 at(eye.at);
  const double length = glm::length(at);
  if (eye.orthographic) {
    const bool cullable = length >= kShortestDirection && length <= kFarthestEye;
    return {cullable ? at / length : DVec3(0.0), 0.0, cullable};
  }
  const bool cullable = length <= kFarthestEye;
  return {cullable ? (at - frame.center) * frame.per_unit : DVec3(0.0), 1.0, cullable};
}

}  // namespace limn
