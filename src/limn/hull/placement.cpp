#include "limn/hull/placement.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>
#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace limn {
namespace {

constexpr double kParallel = 1e-20;                             // square of the sine of an angle between planes
constexpr float kNowhere = -std::numeric_limits<float>::max();  // offset of a half-space that holds everything
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
    case 0:
      return {normal, {}};
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

void PlacementPlanes::reserve(std::size_t count) {
  if (count + kLanes <= nx_.size()) return;
  const std::size_t size = std::max<std::size_t>(64, 2 * (count + kLanes));
  for (std::vector<float>* values : {&nx_, &ny_, &nz_, &offset_, &area_, &side_})
    values->resize(size);
}

void PlacementPlanes::set(std::span<const FacePlane> planes, std::span<const FaceId> faces, std::size_t count_a,
                          const Vec3& half, float margin) {
  count_ = faces.size();
  reserve(count_);
  for (std::size_t i = 0; i < count_; ++i) {
    const FacePlane& plane = planes[faces[i]];
    nx_[i] = plane.normal.x;
    ny_[i] = plane.normal.y;
    nz_[i] = plane.normal.z;
    area_[i] = plane.area;
    side_[i] = i < count_a ? -1.0f : 1.0f;
  }
  pad();
  // Whole groups of lanes, so that compilers make vector code of it.
  for (std::size_t i = 0; i < count_; i += kLanes) {
    for (std::size_t k = i; k < i + kLanes; ++k) {
      const float base = nx_[k] * half.x + ny_[k] * half.y + nz_[k] * half.z;
      offset_[k] = area_[k] > 0.0f ? side_[k] * base + margin : kNowhere;
    }
  }
}

void PlacementPlanes::add(const Vec3& normal, float offset) {
  reserve(count_ + 1);
  nx_[count_] = normal.x;
  ny_[count_] = normal.y;
  nz_[count_] = normal.z;
  area_[count_] = 0.0f;
  offset_[count_++] = offset;
}

/// Fills the last group of lanes with half-spaces that everything is in.
void PlacementPlanes::pad() {
  for (std::size_t i = count_; i % kLanes != 0; ++i) {
    nx_[i] = ny_[i] = nz_[i] = area_[i] = side_[i] = 0.0f;
    offset_[i] = kNowhere;
  }
}

DVec3 PlacementPlanes::gradient() const {
  std::array<float, kLanes> x{}, y{}, z{};
  for (std::size_t i = 0; i < count_; i += kLanes) {
    for (std::size_t k = 0; k < kLanes; ++k) {
      x[k] += area_[i + k] * nx_[i + k];
      y[k] += area_[i + k] * ny_[i + k];
      z[k] += area_[i + k] * nz_[i + k];
    }
  }
  const auto sum = [](const std::array<float, kLanes>& v) { return double{(v[0] + v[1]) + (v[2] + v[3])}; };
  return {sum(x), sum(y), sum(z)};
}

double PlacementPlanes::volume3(const DVec3& at, float margin) const {
  const Vec3 p(at);
  std::array<float, kLanes> sum{};
  for (std::size_t i = 0; i < count_; i += kLanes) {
    for (std::size_t k = 0; k < kLanes; ++k) {
      const float side = nx_[i + k] * p.x + ny_[i + k] * p.y + nz_[i + k] * p.z - offset_[i + k];
      const float distance = area_[i + k] > 0.0f ? side + margin : 0.0f;
      sum[k] += area_[i + k] * (distance > 0.0f ? distance : 0.0f);
    }
  }
  return double{(sum[0] + sum[1]) + (sum[2] + sum[3])};
}

#if defined(__SSE2__)
std::size_t PlacementPlanes::most_violated(const DVec3& x, float& least) {
  if (count_ % kLanes != 0) pad();
  const __m128 px = _mm_set1_ps(static_cast<float>(x.x));
  const __m128 py = _mm_set1_ps(static_cast<float>(x.y));
  const __m128 pz = _mm_set1_ps(static_cast<float>(x.z));
  __m128 lowest = _mm_set1_ps(std::numeric_limits<float>::max());
  for (std::size_t i = 0; i < count_; i += kLanes) {
    const __m128 xy = _mm_add_ps(_mm_mul_ps(_mm_loadu_ps(&nx_[i]), px), _mm_mul_ps(_mm_loadu_ps(&ny_[i]), py));
    const __m128 xyz = _mm_add_ps(xy, _mm_mul_ps(_mm_loadu_ps(&nz_[i]), pz));
    const __m128 side = _mm_sub_ps(xyz, _mm_loadu_ps(&offset_[i]));
    _mm_storeu_ps(&side_[i], side);
    lowest = _mm_min_ps(lowest, side);
  }
  lowest = _mm_min_ps(lowest, _mm_shuffle_ps(lowest, lowest, _MM_SHUFFLE(1, 0, 3, 2)));
  lowest = _mm_min_ps(lowest, _mm_shuffle_ps(lowest, lowest, _MM_SHUFFLE(2, 3, 0, 1)));
  least = _mm_cvtss_f32(lowest);
  for (std::size_t i = 0; i < count_; i += kLanes) {
    const int equal = _mm_movemask_ps(_mm_cmpeq_ps(_mm_loadu_ps(&side_[i]), lowest));
    if (equal != 0) return i + static_cast<std::size_t>(std::countr_zero(static_cast<unsigned>(equal)));
  }
  return 0;
}
#else
std::size_t PlacementPlanes::most_violated(const DVec3& x, float& least) {
  const Vec3 p(x);
  std::size_t worst = 0;
  least = std::numeric_limits<float>::max();
  for (std::size_t i = 0; i < count_; ++i) {
    const float side = nx_[i] * p.x + ny_[i] * p.y + nz_[i] * p.z - offset_[i];
    if (side < least) {
      least = side;
      worst = i;
    }
  }
  return worst;
}
#endif

bool nearest_point(PlacementPlanes& planes, const DVec3& target, DVec3& point) {
  point = target;
  if (planes.size() == 0) return true;
  ActiveSet active;
  const std::size_t most_steps = 4 * planes.size() + 16;
  for (std::size_t step = 0; step < most_steps; ++step) {
    float rough = 0.0f;
    const std::size_t worst = planes.most_violated(point, rough);
    if (double{rough} >= -0.5 * kPlacementTolerance) return true;
    // Far from the frame's middle floats may see what is not there.
    const double side = planes.side(worst, point);
    if (side >= 0.0) return glm::dot(point, point) < 1e4;
    if (!enter(active, planes.normal(worst), side, point)) return false;
  }
  return false;
}

}  // namespace limn
