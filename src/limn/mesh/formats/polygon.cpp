#include "limn/mesh/formats/polygon.h"

#include <cmath>

namespace limn::formats {
namespace {

using DVec2 = glm::dvec2;

constexpr std::size_t kMostCornersCut = 256;

/// The sum of the cross products of consecutive corners, taken about corner 0 so that far-off polygons keep their
/// digits.
DVec3 newell_normal(std::span<const Vec3> corners) {
  const DVec3 origin(corners[0]);
  DVec3 sum(0.0);
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    sum += glm::cross(DVec3(corners[i]) - origin, DVec3(corners[i + 1]) - origin);
  }
  return sum;
}

/// The corners seen along the normal's largest component, counter-clockwise.
std::vector<DVec2> flatten(std::span<const Vec3> corners, const DVec3& normal) {
  const DVec3 size = glm::abs(normal);
  const int axis = size.x > size.y && size.x > size.z ? 0 : (size.y > size.z ? 1 : 2);
  const bool negative = normal[axis] < 0.0;
  const int u = (axis + (negative ? 2 : 1)) % 3;
  const int v = (axis + (negative ? 1 : 2)) % 3;
  std::vector<DVec2> flat;
  flat.reserve(corners.size());
  for (const Vec3& p : corners)
    flat.emplace_back(p[u], p[v]);
  return flat;
}

/// Twice the signed area of a triangle: positive when a, b, c run counter-clockwise.
double turn(const DVec2& a, const DVec2& b, const DVec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

bool is_convex(const std::vector<DVec2>& flat) {
  const std::size_t n = flat.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (turn(flat[i], flat[(i + 1) % n], flat[(i + 2) % n]) < 0.0) return false;
  }
  return true;
}

/// Whether the corner at `at` of the ring can be cut off: it turns left, and no other corner lies in its triangle.
bool is_ear(const std::vector<DVec2>& flat, const std::vector<std::uint32_t>& ring, std::size_t at) {
  const std::size_t n = ring.size();
  const DVec2& a = flat[ring[(at + n - 1) % n]];
  const DVec2& b = flat[ring[at]];
  const DVec2& c = flat[ring[(at + 1) % n]];
  if (turn(a, b, c) <= 0.0) return false;
  for (std::size_t i = 2; i + 1 < n; ++i) {
    const DVec2& p = flat[ring[(at + i) % n]];
    if (p == a || p == b || p == c) continue;
    if (turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0) return false;
  }
  return true;
}

}  // namespace

void triangulate(std::span<const Vec3> corners, std::vector<std::array<std::uint32_t, 3>>& triangles) {
  const std::size_t n = corners.size();
  std::vector<std::uint32_t> ring(n);
  for (std::size_t i = 0; i < n; ++i)
    ring[i] = static_cast<std::uint32_t>(i);
  if (n > 3 && n <= kMostCornersCut) {
    const std::vector<DVec2> flat = flatten(corners, newell_normal(corners));
    std::size_t at = 0;
    std::size_t refused = is_convex(flat) ? n : 0;
    while (ring.size() > 3 && refused < ring.size()) {
      at %= ring.size();
      if (!is_ear(flat, ring, at)) {
        ++at;
        ++refused;
        continue;
      }
      const std::size_t left = ring.size();
      triangles.push_back({ring[(at + left - 1) % left], ring[at], ring[(at + 1) % left]});
      ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(at));
      refused = 0;
    }
  }
  for (std::size_t i = 1; i + 1 < ring.size(); ++i)
    triangles.push_back({ring[0], ring[i], ring[i + 1]});
}

}  // namespace limn::formats
