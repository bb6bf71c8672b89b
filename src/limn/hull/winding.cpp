#include "limn/hull/winding.h"

#include <algorithm>
#include <array>

#include "limn/base/orient3d.h"
#include "limn/base/random.h"

namespace limn {
namespace {

constexpr int kSegments = 16;

/// Whether the segment p q crosses the triangle: 1 from its front to its back, -1 the other way, 0 not at all; nothing
/// where it meets the border, ends on the triangle or lies in its plane.
std::optional<int> crossing(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
  const int at_p = orient3d(a, b, c, p);
  const int at_q = orient3d(a, b, c, q);
  if (at_p != 0 && at_p == at_q) return 0;
  const std::array<int, 3> sides{orient3d(p, q, a, b), orient3d(p, q, b, c), orient3d(p, q, c, a)};
  const bool some_left = std::any_of(sides.begin(), sides.end(), [](int s) { return s > 0; });
  const bool some_right = std::any_of(sides.begin(), sides.end(), [](int s) { return s < 0; });
  if (some_left && some_right) return 0;
  const bool grazes = std::any_of(sides.begin(), sides.end(), [](int s) { return s == 0; });
  if (grazes || at_p == 0 || at_q == 0) return std::nullopt;
  return at_p;
}

std::optional<int> crossings(std::span<const Vec3> positions, std::span<const Triangle> faces, const Vec3& p,
                             const Vec3& q) {
  int sum = 0;
  for (const Triangle& face : faces) {
    const std::optional<int> one = crossing(p, q, positions[face[0]], positions[face[1]], positions[face[2]]);
    if (!one) return std::nullopt;
    sum -= *one;
  }
  return sum;
}

}  // namespace

std::optional<int> winding_number(std::span<const Vec3> positions, std::span<const Triangle> faces, const Vec3& point) {
  Bounds box;
  box.add(point);
  for (const Triangle& face : faces) {
    for (const VertexId v : face)
      box.add(positions[v]);
  }
  const DVec3 size = DVec3(box.high) - DVec3(box.low);
  Random random(1);
  for (int i = 0; i < kSegments; ++i) {
    // On a side of a box half as large again, so surely outside.
    const DVec3 toss(random.uniform(), random.uniform(), random.uniform());
    DVec3 end = DVec3(box.low) + size * toss;
    end[i % 3] = box.high[i % 3] + 0.5 * std::max({size.x, size.y, size.z});
    const Vec3 q(end);
    if (!is_finite(q) || !(q[i % 3] > box.high[i % 3])) continue;
    if (const std::optional<int> sum = crossings(positions, faces, point, q)) return sum;
  }
  return std::nullopt;
}

bool is_clear_of(const Bounds& box, const Vec3& a, const Vec3& b, const Vec3& c) {
  for (int axis = 0; axis < 3; ++axis) {
    if (std::min({a[axis], b[axis], c[axis]}) > box.high[axis]) return true;
    if (std::max({a[axis], b[axis], c[axis]}) < box.low[axis]) return true;
  }
  int side = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p((corner & 1) != 0 ? box.high.x : box.low.x, (corner & 2) != 0 ? box.high.y : box.low.y,
                 (corner & 4) != 0 ? box.high.z : box.low.z);
    const int here = orient3d(a, b, c, p);
    if (here == 0 || (side != 0 && here != side)) return false;
    side = here;
  }
  return true;
}

}  // namespace limn
