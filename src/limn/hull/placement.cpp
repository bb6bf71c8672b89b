#include "limn/hull/placement.h"

#include <array>
#include <glm/geometric.hpp>
#include <limits>

namespace limn {
namespace {

constexpr double kParallel = 1e-20;  // square of the sine of an angle between planes
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The half-spaces that hold the point, with their multipliers.
struct ActiveSet {
  int count = 0;
  std::array<DVec3, 3> normal;
  std::array<double, 3> force{};

  void remove(int i) {
    for (--count; i < count; ++i) {
      normal[static_cast<std::size_t>(i)] = normal[static_cast<std::size_t>(i) + 1];
      force[static_cast<std::size_t>(i)] = force[static_cast<std::size_t>(i) + 1];
    }
  }
};

/// normal = Σ part[i] active normal[i] + rest, the rest orthogonal to all of them.
struct Split {
  DVec3 rest{0.0};
  std::array<double, 3> part{};
};

Split split(const ActiveSet& active, const DVec3& normal) {
  const auto& n = active.normal;
  switch (active.count) {
    case 0: return {normal, {}};
    case 1: {
      const double part = glm::dot(normal, n[0]);
      return {normal - part * n[0], {part}};
    }
    case 2: {
      const DVec3 axis = glm::cross(n[0], n[1]);
      const double inverse = 1.0 / glm::dot(axis, axis);
      return {(glm::dot(normal, axis) * inverse) * axis,
              {glm::dot(glm::cross(normal, n[1]), axis) * inverse, glm::dot(glm::cross(n[0], normal), axis) * inverse}};
    }
    default: {
      const DVec3 c12 = glm::cross(n[1], n[2]);
      const double inverse = 1.0 / glm::dot(n[0], c12);
      return {DVec3(0.0),
              {glm::dot(normal, c12) * inverse, glm::dot(normal, glm::cross(n[2], n[0])) * inverse,
               glm::dot(normal, glm::cross(n[0], n[1])) * inverse}};
    }
  }
}

/// Moves the point into a half-space that it is `side` < 0 outside of. \return false where there is no way
bool enter(ActiveSet& active, const DVec3& normal, double side, DVec3& point) {
  double force = 0.0;
  while (true) {
    const Split parts = split(active, normal);
    const double rise = glm::dot(parts.rest, parts.rest);
    const double whole = rise > kParallel ? -side / rise : kInfinity;
    double step = whole;
    int freed = -1;
    for (int i = 0; i < active.count; ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (parts.part[k] * step > active.force[k]) {
        step = active.force[k] / parts.part[k];
        freed = i;
      }
    }
    if (step == kInfinity) return false;
    for (int i = 0; i < active.count; ++i)
      active.force[static_cast<std::size_t>(i)] -= step * parts.part[static_cast<std::size_t>(i)];
    force += step;
    if (whole < kInfinity) {
      point += step * parts.rest;
      side += step * rise;
    }
    if (freed < 0) break;
    active.remove(freed);
  }
  active.normal[static_cast<std::size_t>(active.count)] = normal;
  active.force[static_cast<std::size_t>(active.count++)] = force;
  return true;
}

}  // namespace

void PlacementPlanes::grow() {
  const std::size_t size = nx_.empty() ? 64 : 2 * nx_.size();
  for (std::vector<double>* values : {&nx_, &ny_, &nz_, &offset_})
    values->resize(size);
}

std::size_t PlacementPlanes::most_violated(const DVec3& x, double& least) const {
  std::size_t worst = 0;
  least = kInfinity;
  for (std::size_t i = 0; i < count_; ++i) {
    const double s = side(i, x);
    if (s < least) {
      least = s;
      worst = i;
    }
  }
  return worst;
}

bool nearest_point(const PlacementPlanes& planes, const DVec3& target, double tolerance, DVec3& point) {
  point = target;
  ActiveSet active;
  const std::size_t most_steps = 4 * planes.size() + 16;
  for (std::size_t step = 0; step < most_steps; ++step) {
    double side = 0.0;
    const std::size_t worst = planes.most_violated(point, side);
    if (side >= -tolerance) return true;
    if (!enter(active, planes.normal(worst), side, point)) return false;
  }
  return false;
}

}  // namespace limn
