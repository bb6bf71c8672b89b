#include "limn/base/orient3d.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <glm/geometric.hpp>

namespace limn {
namespace {

constexpr double kEpsilon = 0x1.0p-53;
// Shewchuk's bound for the error of the determinant of differences, in units of its permanent.
constexpr double kErrorBound = (7.0 + 56.0 * kEpsilon) * kEpsilon;
constexpr double kSplitter = 0x1.0p27 + 1.0;

/// An exact sum of doubles that do not overlap, the least first; `count` of them.
template <std::size_t kCapacity>
struct Expansion {
  std::array<double, kCapacity> term;
  std::size_t count = 0;

  void push(double value) {
    if (value != 0.0) term[count++] = value;
  }
};

/// sum + error = a + b exactly.
struct Pair {
  double sum, error;
};

Pair two_sum(double a, double b) {
  const double sum = a + b;
  const double b_virtual = sum - a;
  return {sum, (a - (sum - b_virtual)) + (b - b_virtual)};
}

Pair two_product(double a, double b) {
  const double product = a * b;
  const auto split = [](double value) {
    const double c = kSplitter * value;
    const double high = c - (c - value);
    return Pair{high, value - high};
  };
  const Pair x = split(a);
  const Pair y = split(b);
  const double error = x.error * y.error - (((product - x.sum * y.sum) - x.error * y.sum) - x.sum * y.error);
  return {product, error};
}

template <std::size_t kCapacity>
void add(Expansion<kCapacity>& sum, double value) {
  Expansion<kCapacity> result;
  double carry = value;
  for (std::size_t i = 0; i < sum.count; ++i) {
    const Pair next = two_sum(carry, sum.term[i]);
    result.push(next.error);
    carry = next.sum;
  }
  result.push(carry);
  sum = result;
}

/// sum += sign · a · b · c, each of them a difference of floats as a pair: 8 products of 3 doubles.
template <std::size_t kCapacity>
void add_product(Expansion<kCapacity>& sum, const Pair& a, const Pair& b, const Pair& c, double sign) {
  for (const double x : {a.error, a.sum}) {
    for (const double y : {b.error, b.sum}) {
      if (x == 0.0 || y == 0.0) continue;
      const Pair xy = two_product(x, y);
      for (const double z : {c.error, c.sum}) {
        if (z == 0.0) continue;
        const Pair low = two_product(xy.error, sign * z);
        const Pair high = two_product(xy.sum, sign * z);
        for (const double term : {low.error, low.sum, high.error, high.sum}) {
          if (term != 0.0) add(sum, term);
        }
      }
    }
  }
}

struct Difference {
  Pair x, y, z;
};

Difference difference(const Vec3& p, const Vec3& q) {
  const auto one = [](float a, float b) { return two_sum(static_cast<double>(a), -static_cast<double>(b)); };
  return {one(p.x, q.x), one(p.y, q.y), one(p.z, q.z)};
}

int orient3d_exact(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Difference u = difference(b, a);
  const Difference v = difference(c, a);
  const Difference w = difference(d, a);
  Expansion<192> sum;
  add_product(sum, u.y, v.z, w.x, 1.0);
  add_product(sum, u.z, v.y, w.x, -1.0);
  add_product(sum, u.z, v.x, w.y, 1.0);
  add_product(sum, u.x, v.z, w.y, -1.0);
  add_product(sum, u.x, v.y, w.z, 1.0);
  add_product(sum, u.y, v.x, w.z, -1.0);
  if (sum.count == 0) return 0;
  return sum.term[sum.count - 1] > 0.0 ? 1 : -1;
}

}  // namespace

int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const DVec3 u = DVec3(b) - DVec3(a);
  const DVec3 v = DVec3(c) - DVec3(a);
  const DVec3 w = DVec3(d) - DVec3(a);
  const double yz = u.y * v.z, zy = u.z * v.y;
  const double zx = u.z * v.x, xz = u.x * v.z;
  const double xy = u.x * v.y, yx = u.y * v.x;
  const double determinant = (yz - zy) * w.x + (zx - xz) * w.y + (xy - yx) * w.z;
  const double permanent = (std::abs(yz) + std::abs(zy)) * std::abs(w.x) +
                           (std::abs(zx) + std::abs(xz)) * std::abs(w.y) +
                           (std::abs(xy) + std::abs(yx)) * std::abs(w.z);
  const double bound = kErrorBound * permanent;
  if (determinant > bound) return 1;
  if (determinant < -bound) return -1;
  return orient3d_exact(a, b, c, d);
}

}  // namespace limn
