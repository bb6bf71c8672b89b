#include "support/exact.h"

#include <cmath>

namespace limn::test {
namespace {

/// a + b = sum + rest, exactly.
void two_sum(double a, double b, double& sum, double& rest) {
  sum = a + b;
  const double from_b = sum - a;
  rest = (a - (sum - from_b)) + (b - from_b);
}

/// A filter: what double says where its error cannot matter, else 0. \param size  the sum of the sizes of all products
int sure_sign(double value, double size) {
  return value > 1e-14 * size ? 1 : value < -1e-14 * size ? -1 : 0;
}

}  // namespace

Exact::Exact(double value) {
  if (value != 0.0) parts_.push_back(value);
}

void Exact::add(double value) {
  std::vector<double> parts;
  double sum = value;
  for (const double part : parts_) {
    double rest = 0;
    two_sum(sum, part, sum, rest);
    if (rest != 0.0) parts.push_back(rest);
  }
  if (sum != 0.0) parts.push_back(sum);
  parts_ = std::move(parts);
}

Exact Exact::times(double value) const {
  Exact result;
  for (const double part : parts_) {
    const double product = part * value;
    result.add(std::fma(part, value, -product));
    result.add(product);
  }
  return result;
}

Exact Exact::operator+(const Exact& other) const {
  Exact result = *this;
  for (const double part : other.parts_)
    result.add(part);
  return result;
}

Exact Exact::operator-(const Exact& other) const {
  Exact result = *this;
  for (const double part : other.parts_)
    result.add(-part);
  return result;
}

Exact Exact::operator*(const Exact& other) const {
  Exact result;
  for (const double part : other.parts_)
    result = result + times(part);
  return result;
}

int Exact::sign() const {
  // The last part is greater than all others together.
  return parts_.empty() ? 0 : parts_.back() > 0 ? 1 : -1;
}

int exact_side(const DVec3& a, const DVec3& b, const DVec3& c, const DVec3& d) {
  const DVec3 u = b - a, v = c - a, w = d - a;
  const double xy = u.x * v.y - u.y * v.x, yz = u.y * v.z - u.z * v.y, zx = u.z * v.x - u.x * v.z;
  const double size = (std::abs(u.x * v.y) + std::abs(u.y * v.x)) * std::abs(w.z) +
                      (std::abs(u.y * v.z) + std::abs(u.z * v.y)) * std::abs(w.x) +
                      (std::abs(u.z * v.x) + std::abs(u.x * v.z)) * std::abs(w.y);
  if (const int sure = sure_sign(yz * w.x + zx * w.y + xy * w.z, size); sure != 0) return sure;
  const auto minus = [](double p, double q) { return Exact(p) - Exact(q); };
  const Exact ux = minus(b.x, a.x), uy = minus(b.y, a.y), uz = minus(b.z, a.z);
  const Exact vx = minus(c.x, a.x), vy = minus(c.y, a.y), vz = minus(c.z, a.z);
  const Exact wx = minus(d.x, a.x), wy = minus(d.y, a.y), wz = minus(d.z, a.z);
  return ((uy * vz - uz * vy) * wx + (uz * vx - ux * vz) * wy + (ux * vy - uy * vx) * wz).sign();
}

int exact_turn(const DVec3& a, const DVec3& b, const DVec3& c) {
  const DVec3 u = b - a, v = c - a;
  const double left = u.x * v.y, right = u.y * v.x;
  if (const int sure = sure_sign(left - right, std::abs(left) + std::abs(right)); sure != 0) return sure;
  const auto minus = [](double p, double q) { return Exact(p) - Exact(q); };
  return (minus(b.x, a.x) * minus(c.y, a.y) - minus(b.y, a.y) * minus(c.x, a.x)).sign();
}

}  // namespace limn::test
