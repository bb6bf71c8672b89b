#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "limn/base/vec.h"
#include "limn/mesh/ids.h"

namespace limn {

/// Unit normal and area of a face; both 0 for a face without extent.
struct FacePlane {
  Vec3 normal{0};
  float area = 0;
};

/// Half-spaces normal·x >= offset with unit normals and weights, side by side for the processor's sake, in a frame
/// whose unit is about how far away answers are: floats are enough there.
class PlacementPlanes {
 public:
  /// Half-spaces in front of faces, each pushed out by `margin`. Faces without extent are in front of nothing.
  /// \param faces  indices into planes; the first `count_a` of them pass through -half, the others through half
  void set(std::span<const FacePlane> planes, std::span<const FaceId> faces, std::size_t count_a, const Vec3& half,
           float margin);

  /// One by one instead. \pre normal is of unit length
  void clear() { count_ = 0; }
  void add(const Vec3& normal, float offset);

  std::size_t size() const { return count_; }
  DVec3 normal(std::size_t i) const { return {double{nx_[i]}, double{ny_[i]}, double{nz_[i]}}; }
  /// Distance of x into the half-space; negative outside of it.
  double side(std::size_t i, const DVec3& x) const {
    return double{nx_[i]} * x.x + double{ny_[i]} * x.y + double{nz_[i]} * x.z - double{offset_[i]};
  }
  /// The half-space that x is farthest outside of (of equals the first), and its side in float. \pre size() > 0
  std::size_t most_violated(const DVec3& x, float& side);
  /// Sum of area times normal, of the faces that were set.
  DVec3 gradient() const;
  /// Sum of area times distance of x from the faces' planes, in front of them: three times the volume added.
  double volume3(const DVec3& x, float margin) const;

 private:
  static constexpr std::size_t kLanes = 4;
  void reserve(std::size_t count);
  void pad();

  std::vector<float> nx_, ny_, nz_, offset_, area_, side_;
  std::size_t count_ = 0;
};

/// How far outside a half-space the point of nearest_point() may be, in units of the frame, for points within a few of
/// those: what floats leave open.
inline constexpr double kPlacementTolerance = 1e-6;

/// Finds the point of all half-spaces nearest to `target`.
///
/// With the target far below along a cost's gradient, this is the linear program with ties broken towards a point: for
/// target = m − (h/ε) g the minimum of g·x + ε|x − m|²/2h. Dual active sets (Goldfarb and Idnani 1983): each step adds
/// the most violated half-space and lets go of what no longer holds the point back; at most three hold it at a time.
/// \return whether there is such a point; also false, which wrongs nobody, when rounding stops the steps
/// Cost: some ten steps of one pass over the half-spaces. Same input, same bits.
/// Sander et al. 2000, section 3; docs/hull.md
bool nearest_point(PlacementPlanes& planes, const DVec3& target, DVec3& point);

}  // namespace limn
