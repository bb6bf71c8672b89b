#pragma once

#include <cstddef>
#include <vector>

#include "limn/base/vec.h"

namespace limn {

/// Half-spaces normal·x >= offset with unit normals, side by side for the processor's sake.
class PlacementPlanes {
 public:
  void clear() { count_ = 0; }
  std::size_t size() const { return count_; }
  void add(const DVec3& normal, double offset) {
    if (count_ == nx_.size()) grow();
    nx_[count_] = normal.x;
    ny_[count_] = normal.y;
    nz_[count_] = normal.z;
    offset_[count_++] = offset;
  }
  DVec3 normal(std::size_t i) const { return {nx_[i], ny_[i], nz_[i]}; }
  double side(std::size_t i, const DVec3& x) const {
    return nx_[i] * x.x + ny_[i] * x.y + nz_[i] * x.z - offset_[i];
  }
  /// The half-space that x is farthest outside of, and by how much (negative; positive when in all).
  std::size_t most_violated(const DVec3& x, double& side) const;

 private:
  void grow();
  std::vector<double> nx_, ny_, nz_, offset_;
  std::size_t count_ = 0;
};

/// Finds the point of all half-spaces nearest to `target`.
///
/// With the target far below along a cost's gradient, this is the linear program with ties broken towards a point: for
/// target = m − (h/ε) g the minimum of g·x + ε|x − m|²/2h. Dual active sets (Goldfarb and Idnani 1983): each step adds
/// the most violated half-space and lets go of what no longer holds the point back; at most three hold it at a time.
/// \param tolerance  how far outside a half-space the point may be
/// \return whether there is such a point; also false, which wrongs nobody, when rounding stops the steps
bool nearest_point(const PlacementPlanes& planes, const DVec3& target, double tolerance, DVec3& point);

}  // namespace limn
