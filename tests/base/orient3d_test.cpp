#include "limn/base/orient3d.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <vector>

#include "limn/base/random.h"

namespace limn {
namespace {

/// A whole number of any size, in 32-bit digits, the lowest first: as slow and plain as can be.
class Whole {
 public:
  Whole() = default;
  /// A float in units of 2^-149.
  explicit Whole(float value) : negative_(std::signbit(value)) {
    int exponent = 0;
    const float mantissa = std::frexp(std::abs(value), &exponent);
    auto digits = static_cast<std::uint64_t>(std::ldexp(mantissa, 24));
    int shift = exponent - 24 + 149;
    for (; shift < 0; ++shift)
      digits >>= 1;  // denormals: the bits shifted out are 0
    digits_.assign(static_cast<std::size_t>(shift / 32), 0);
    const std::uint64_t low = digits << (shift % 32);
    digits_.push_back(static_cast<std::uint32_t>(low));
    digits_.push_back(static_cast<std::uint32_t>(low >> 32));
    trim();
  }

  int sign() const { return digits_.empty() ? 0 : negative_ ? -1 : 1; }

  Whole operator-() const {
    Whole result = *this;
    result.negative_ = !negative_;
    return result;
  }

  friend Whole operator+(const Whole& a, const Whole& b) {
    if (a.negative_ != b.negative_) return less(a, b) ? subtract(b, a) : subtract(a, b);
    Whole sum;
    sum.negative_ = a.negative_;
    std::uint64_t carry = 0;
    for (std::size_t i = 0; i < std::max(a.digits_.size(), b.digits_.size()) + 1; ++i) {
      carry += a.digit(i) + b.digit(i);
      sum.digits_.push_back(static_cast<std::uint32_t>(carry));
      carry >>= 32;
    }
    sum.trim();
    return sum;
  }

  friend Whole operator-(const Whole& a, const Whole& b) { return a + -b; }

  friend Whole operator*(const Whole& a, const Whole& b) {
    Whole product;
    product.negative_ = a.negative_ != b.negative_;
    product.digits_.assign(a.digits_.size() + b.digits_.size() + 1, 0);
    for (std::size_t i = 0; i < a.digits_.size(); ++i) {
      std::uint64_t carry = 0;
      for (std::size_t j = 0; j < b.digits_.size() + 1; ++j) {
        carry += product.digits_[i + j] + a.digit(i) * b.digit(j);
        product.digits_[i + j] = static_cast<std::uint32_t>(carry);
        carry >>= 32;
      }
    }
    product.trim();
    return product;
  }

 private:
  std::uint64_t digit(std::size_t i) const { return i < digits_.size() ? digits_[i] : 0; }

  void trim() {
    while (!digits_.empty() && digits_.back() == 0)
      digits_.pop_back();
  }

  /// By size alone.
  static bool less(const Whole& a, const Whole& b) {
    if (a.digits_.size() != b.digits_.size()) return a.digits_.size() < b.digits_.size();
    return std::lexicographical_compare(a.digits_.rbegin(), a.digits_.rend(), b.digits_.rbegin(), b.digits_.rend());
  }

  /// With the sign of a. \pre a is no smaller in size
  static Whole subtract(const Whole& a, const Whole& b) {
    Whole rest;
    rest.negative_ = a.negative_;
    std::int64_t borrow = 0;
    for (std::size_t i = 0; i < a.digits_.size(); ++i) {
      std::int64_t digit = static_cast<std::int64_t>(a.digit(i)) - static_cast<std::int64_t>(b.digit(i)) + borrow;
      borrow = digit < 0 ? -1 : 0;
      digit -= borrow * (std::int64_t{1} << 32);
      rest.digits_.push_back(static_cast<std::uint32_t>(digit));
    }
    rest.trim();
    return rest;
  }

  bool negative_ = false;
  std::vector<std::uint32_t> digits_;
};

int oracle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const auto difference = [](const Vec3& p, const Vec3& q, int axis) { return Whole(p[axis]) - Whole(q[axis]); };
  const Whole ux = difference(b, a, 0), uy = difference(b, a, 1), uz = difference(b, a, 2);
  const Whole vx = difference(c, a, 0), vy = difference(c, a, 1), vz = difference(c, a, 2);
  const Whole wx = difference(d, a, 0), wy = difference(d, a, 1), wz = difference(d, a, 2);
  return ((uy * vz - uz * vy) * wx + (uz * vx - ux * vz) * wy + (ux * vy - uy * vx) * wz).sign();
}

void expect_exact(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const int side = oracle(a, b, c, d);
  ASSERT_EQ(orient3d(a, b, c, d), side);
  ASSERT_EQ(orient3d(b, c, a, d), side);
  ASSERT_EQ(orient3d(b, a, c, d), -side);
}

TEST(Orient3d, IsPositiveWhereTheTriangleIsSeenCounterClockwise) {
  EXPECT_EQ(orient3d({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}), 1);
  EXPECT_EQ(orient3d({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}), -1);
  EXPECT_EQ(orient3d({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, -3, 0}), 0);
  EXPECT_EQ(orient3d({0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {5, -3, 0}), 0);
}

TEST(Orient3d, EqualsWholeNumbersOnRandomPoints) {
  Random random(1);
  for (int trial = 0; trial < 2000; ++trial) {
    Vec3 p[4];
    for (Vec3& q : p)
      q = Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    expect_exact(p[0], p[1], p[2], p[3]);
  }
}

TEST(Orient3d, EqualsWholeNumbersAFewUlpsFromThePlane) {
  Random random(2);
  int zeros = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const auto grid = [&] { return static_cast<float>(random.below(64)) / 8.0f + 1000.0f; };
    const Vec3 a(grid(), grid(), grid()), b(grid(), grid(), grid()), c(grid(), grid(), grid());
    const double s = static_cast<double>(random.below(5)) / 4, t = static_cast<double>(random.below(5)) / 4;
    Vec3 d(DVec3(a) + s * (DVec3(b) - DVec3(a)) + t * (DVec3(c) - DVec3(a)));
    const int axis = static_cast<int>(random.below(3));
    const std::uint64_t nudge = random.below(3);
    if (nudge == 1) d[axis] = std::nextafter(d[axis], 1e30f);
    if (nudge == 2) d[axis] = std::nextafter(d[axis], -1e30f);
    expect_exact(a, b, c, d);
    zeros += oracle(a, b, c, d) == 0 ? 1 : 0;
  }
  EXPECT_GT(zeros, 500);
}

TEST(Orient3d, EqualsWholeNumbersAtEveryScaleMixed) {
  Random random(3);
  for (int trial = 0; trial < 3000; ++trial) {
    const auto any = [&] {
      const int exponent = static_cast<int>(random.below(278)) - 150;
      const auto value = static_cast<float>(std::ldexp(random.uniform(-1, 1), exponent));
      return std::isfinite(value) ? value : 1.0f;
    };
    const Vec3 a(any(), any(), any()), b(any(), any(), any()), c(any(), any(), any());
    expect_exact(a, b, c, Vec3(any(), any(), any()));
    // In the plane, to within rounding at the largest coordinate's scale.
    const Vec3 d(0.25 * DVec3(a) + 0.25 * DVec3(b) + 0.5 * DVec3(c));
    if (is_finite(d)) expect_exact(a, b, c, d);
  }
}

TEST(Orient3d, NeitherOverflowsNorUnderflows) {
  const float huge = std::numeric_limits<float>::max();
  const float tiny = std::numeric_limits<float>::denorm_min();
  expect_exact({-huge, -huge, -huge}, {huge, -huge, -huge}, {-huge, huge, -huge}, {huge, huge, huge});
  expect_exact({0, 0, 0}, {tiny, 0, 0}, {0, tiny, 0}, {0, 0, tiny});
  expect_exact({-huge, 0, 0}, {huge, tiny, 0}, {-huge, huge, tiny}, {huge, huge, tiny});
}

}  // namespace
}  // namespace limn
