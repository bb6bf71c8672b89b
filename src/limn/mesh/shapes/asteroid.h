#pragma once

#include <cstdint>
#include <vector>

#include "limn/mesh/shapes/grid.h"
#include "limn/mesh/shapes/noise.h"

namespace limn::procedural {

/// A rock: lumps, craters with rims and roughness, as a radius over the unit sphere. Same seed, same rock.
class AsteroidSurface {
 public:
  struct Crater {
    DVec3 center;
    double radius;  ///< chord, on the unit sphere
  };

  explicit AsteroidSurface(std::uint64_t seed);

  /// The point of the surface in a direction and the surface's exact unit normal there. \pre direction is of unit
  /// length
  SurfacePoint over(const DVec3& direction) const;

 private:
  /// The radius in a direction and its derivative, not yet projected onto the sphere.
  FieldSample radius(const DVec3& direction) const;

  std::uint64_t seed_;
  std::vector<Crater> craters_;
};

}  // namespace limn::procedural
