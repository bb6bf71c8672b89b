#include "limn/refine/patterns/fitted.h"

#include <algorithm>
#include <cmath>

namespace limn {

FittedTriangle fit_triangle(const std::array<std::uint8_t, 3>& sides) {
  const std::int64_t a = std::int64_t{1} << sides[1];
  const std::int64_t b = std::int64_t{1} << sides[2];
  const std::int64_t longest = std::int64_t{1} << (2 * sides[0]);
  return {{std::min(longest, a * a + b * b + a * b), a * a, b * b}};
}

double FittedTriangle::area_scale() const {
  const double middle = static_cast<double>(squared[0] + squared[2] - squared[1]);
  return std::sqrt(4.0 * static_cast<double>(squared[0]) * static_cast<double>(squared[2]) - middle * middle);
}

double FittedTriangle::sharpest_cotangent(const PatternVertex& a, const PatternVertex& b,
                                          const PatternVertex& c) const {
  const PatternVertex* const corners[3] = {&a, &b, &c};
  const auto area = static_cast<double>(twice_area(a, b, c));
  double sharpest = -HUGE_VAL;
  for (std::size_t at = 0; at < 3; ++at) {
    const auto product = static_cast<double>(dot_at(*corners[at], *corners[(at + 1) % 3], *corners[(at + 2) % 3]));
    sharpest = std::max(sharpest, product / area);
  }
  return sharpest / area_scale();
}

std::vector<double> smallest_angles_rad(const Pattern& pattern) {
  const FittedTriangle fitted = fit_triangle(pattern.config.sides);
  std::vector<double> angles;
  angles.reserve(pattern.triangles.size());
  for (const PatternTriangle& t : pattern.triangles) {
    const double cotangent =
        fitted.sharpest_cotangent(pattern.vertices[t[0]], pattern.vertices[t[1]], pattern.vertices[t[2]]);
    angles.push_back(std::atan2(1.0, cotangent));
  }
  return angles;
}

}  // namespace limn
