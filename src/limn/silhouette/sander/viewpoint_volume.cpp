#include "limn/silhouette/sander/viewpoint_volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

namespace limn {
namespace {

struct Node {
  double at, weight;
};

/// Gauss's rule of five points over [0, 1].
constexpr std::array<Node, 5> kGauss = {{{0.04691007703066800, 0.11846344252809454},
                                         {0.23076534494715845, 0.23931433524968324},
                                         {0.5, 0.28444444444444444},
                                         {0.76923465505284155, 0.23931433524968324},
                                         {0.95308992296933200, 0.11846344252809454}}};

constexpr double kHalfRoot3 = 0.86602540378443865;
constexpr double kAround[6][2] = {{1, 0},  {0.5, kHalfRoot3},   {-0.5, kHalfRoot3},
                                  {-1, 0}, {-0.5, -kHalfRoot3}, {0.5, -kHalfRoot3}};

/// The cube of the length of a ray's part within the unit sphere, counted from the ray's begin: far³ − near³.
double cubed_reach(const DVec3& from, double from2, const DVec3& direction) {
  const double along = glm::dot(from, direction);
  const double under = along * along + 1.0 - from2;
  if (!(under > 0.0)) return 0.0;
  const double root = std::sqrt(under);
  const double far = std::max(0.0, root - along);
  const double near = std::max(0.0, -root - along);
  return far * far * far - near * near * near;
}

DVec3 some_perpendicular(const DVec3& axis) {
  const DVec3 other = std::abs(axis.x) < 0.6 ? DVec3(1, 0, 0) : DVec3(0, 1, 0);
  return glm::normalize(glm::cross(axis, other));
}

}  // namespace

double survival_probability(const AnchoredCone& cone, double radius) {
  if (!cone.exists) return 1.0;
  if (std::isinf(radius)) return cone.cosine;
  const DVec3 front = cone.front_anchor / radius;
  const DVec3 back = cone.back_anchor / radius;
  const double front2 = glm::dot(front, front);
  const double back2 = glm::dot(back, back);
  const DVec3 u = some_perpendicular(cone.axis);
  const DVec3 v = glm::cross(cone.axis, u);
  double mean = 0.0;
  for (const Node& node : kGauss) {
    const double height = cone.cosine + (1.0 - cone.cosine) * node.at;
    const double width = std::sqrt(1.0 - height * height);
    for (const auto& [c, s] : kAround) {
      const DVec3 direction = height * cone.axis + width * (c * u + s * v);
      mean += node.weight * (cubed_reach(front, front2, direction) + cubed_reach(back, back2, -direction));
    }
  }
  const double culled = (1.0 - cone.cosine) / 2.0 * (mean / 6.0);
  return std::clamp(1.0 - culled, 0.0, 1.0);
}

}  // namespace limn
