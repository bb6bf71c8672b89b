#pragma once

#include <span>
#include <vector>

#include "limn/base/bounds.h"
#include "limn/base/vec.h"
#include "limn/mesh/ids.h"

namespace limn::test {

/// Winding numbers of a closed surface, exact: signed crossings of a ray along z, the point moved aside by less than
/// anything where the ray would meet an edge. Written apart from limn's own code; shares nothing with it but vectors.
class Winding {
 public:
  /// \pre closed: at every edge as many faces run one way as the other
  Winding(std::span<const Vec3> positions, std::span<const Triangle> faces);

  /// Whether the point lies on a face, its border included.
  bool is_on_surface(const DVec3& point) const;
  /// \pre !is_on_surface(point)
  int at(const DVec3& point) const;
  /// Inside or on the surface: nothing less is out.
  bool holds(const DVec3& point) const { return is_on_surface(point) || at(point) > 0; }

 private:
  struct Face {
    DVec3 a, b, c;
  };
  std::span<const std::uint32_t> faces_above(const DVec3& point) const;
  std::size_t column(double x, int axis) const;

  std::vector<Face> faces_;
  DVec3 low_{0.0}, high_{0.0};
  std::size_t columns_ = 1;  ///< of a square grid over x and y
  std::vector<std::uint32_t> begin_, listed_;
};

}  // namespace limn::test
