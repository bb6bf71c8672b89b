#pragma once

#include <limits>
#include <span>

#include "limn/base/vec.h"

namespace limn {

/// An axis-aligned box; empty (low > high) until a point is added.
struct Bounds {
  Vec3 low{std::numeric_limits<float>::max()};
  Vec3 high{std::numeric_limits<float>::lowest()};

  bool empty() const { return low.x > high.x; }
  void add(const Vec3& p) {
    low = glm::vec3(p.x < low.x ? p.x : low.x, p.y < low.y ? p.y : low.y, p.z < low.z ? p.z : low.z);
    high = glm::vec3(p.x > high.x ? p.x : high.x, p.y > high.y ? p.y : high.y, p.z > high.z ? p.z : high.z);
  }
  /// Computed in double, so that boxes up to the largest floats do not overflow. \pre !empty()
  Vec3 center() const { return Vec3((DVec3(low) + DVec3(high)) * 0.5); }
  /// Length of the diagonal; 0 when empty.
  double diagonal() const {
    if (empty()) return 0.0;
    const DVec3 d = DVec3(high) - DVec3(low);
    return std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
  }
};

/// The box of all points; empty for none.
inline Bounds bounds_of(std::span<const Vec3> points) {
  Bounds bounds;
  for (const Vec3& p : points)
    bounds.add(p);
  return bounds;
}

}  // namespace limn
