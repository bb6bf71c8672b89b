#include "limn/mesh/shapes/asteroid.h"

#include <cmath>
#include <glm/geometric.hpp>

#include "limn/base/random.h"

namespace limn::procedural {
namespace {

std::vector<AsteroidSurface::Crater> scatter_craters(std::uint64_t seed) {
  constexpr int kCraters = 60;
  constexpr double kLargest = 0.55;
  Random random(seed);
  std::vector<AsteroidSurface::Crater> craters;
  for (int i = 0; i < kCraters; ++i) {
    const DVec3 center = glm::normalize(DVec3(random.direction()));
    // Many small ones, few large ones: the number above a radius falls with its square.
    craters.push_back({center, kLargest / std::sqrt(1 + 0.6 * (i + random.uniform()))});
  }
  return craters;
}

/// A bowl inside the radius and a rim around it, flat from √2 radii on; once continuously differentiable.
FieldSample crater_depth(const AsteroidSurface::Crater& crater, const DVec3& direction) {
  const double inverse = 1 / (crater.radius * crater.radius);
  const double q = (2 - 2 * glm::dot(direction, crater.center)) * inverse;  // squared distance in radii
  double value = 0, slope = 0;
  if (q < 1) {
    value -= 0.36 * (1 - q) * (1 - q);
    slope += 0.72 * (1 - q);
  }
  if (q > 0.4 && q < 2) {
    const double s = (q - 0.4) / 1.6, hump = s * (1 - s);
    value += 0.07 * 16 * hump * hump;
    slope += 0.07 * 32 * hump * (1 - 2 * s) / 1.6;
  }
  return {value * crater.radius, slope * crater.radius * (-2 * inverse) * crater.center};
}

}  // namespace

AsteroidSurface::AsteroidSurface(std::uint64_t seed) : seed_(seed), craters_(scatter_craters(seed)) {}

FieldSample AsteroidSurface::radius(const DVec3& direction) const {
  const FieldSample lumps = octave_noise(direction, seed_, {3, 1.0, 0.36, 1.9, 0.42});
  const FieldSample rough = octave_noise(direction, seed_ + 1000, {5, 5.0, 0.034, 2.03, 0.47});
  FieldSample sum{0.72 + lumps.value + rough.value, lumps.gradient + rough.gradient};
  for (const Crater& crater : craters_) {
    const FieldSample one = crater_depth(crater, direction);
    sum.value += one.value;
    sum.gradient += one.gradient;
  }
  return sum;
}

SurfacePoint AsteroidSurface::over(const DVec3& direction) const {
  const FieldSample r = radius(direction);
  // The surface is r(d) d: its normal is r d minus the derivative of r along the sphere.
  const DVec3 along = r.gradient - direction * glm::dot(r.gradient, direction);
  return {direction * r.value, glm::normalize(direction * r.value - along)};
}

}  // namespace limn::procedural
