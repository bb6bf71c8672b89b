#pragma once

#include <vector>

#include "limn/base/vec.h"

namespace limn::test {

/// A number held exactly, as a sum of doubles that do not overlap, smallest first. Slow and plain, written apart from
/// limn's own predicates. Right as long as no product leaves the range of double: coordinates of floats and three of
/// them multiplied do not.
class Exact {
 public:
  Exact() = default;
  explicit Exact(double value);

  Exact operator+(const Exact& other) const;
  Exact operator-(const Exact& other) const;
  Exact operator*(const Exact& other) const;

  /// -1, 0 or 1.
  int sign() const;
  /// Whether one double holds it.
  bool is_double() const { return parts_.size() <= 1; }
  /// \pre is_double()
  double value() const { return parts_.empty() ? 0.0 : parts_.back(); }

 private:
  void add(double value);
  Exact times(double value) const;
  std::vector<double> parts_;
};

/// The sign of (b − a) × (c − a) · (d − a): 1 where d lies on the side from which a, b, c are seen counter-clockwise.
int exact_side(const DVec3& a, const DVec3& b, const DVec3& c, const DVec3& d);

/// The same of (b − a) × (c − a) in the plane of x and y: 1 where a, b, c turn left.
int exact_turn(const DVec3& a, const DVec3& b, const DVec3& c);

}  // namespace limn::test
