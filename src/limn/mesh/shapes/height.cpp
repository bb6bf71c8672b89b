#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "limn/mesh/shapes/builders.h"
#include "limn/mesh/shapes/grid.h"
#include "limn/mesh/shapes/noise.h"

namespace limn::procedural {
namespace {

/// A height over the xz plane with its derivatives along x and z.
struct Height {
  double y, dx, dz;
};

/// A rectangle about the origin with heights above it; u runs along +x, v along -z, so that the front looks up.
template <class HeightAt>
Mesh height_field(const GridSize& size, double half_x, double half_z, const HeightAt& height_at) {
  return open_grid(size, [&](std::size_t i, std::size_t j) {
    const double x = half_x * (2 * static_cast<double>(i) / static_cast<double>(size.u) - 1);
    const double z = half_z * (1 - 2 * static_cast<double>(j) / static_cast<double>(size.v));
    const Height h = height_at(x, z);
    return SurfacePoint{DVec3(x, h.y, z), glm::normalize(DVec3(-h.dx, 1, -h.dz))};
  });
}

/// Hills everywhere, mountains where a slow noise is high.
Height terrain_height(double x, double z, std::uint64_t seed) {
  const FieldSample hills = octave_noise(DVec3(x, 0.37, z), seed, {6, 1.8, 0.08, 2.03, 0.42});
  const FieldSample ridges = ridged_noise(DVec3(x, 0.61, z), seed + 1000, {5, 2.2, 0.30, 2.07, 0.36});
  const FieldSample where = gradient_noise(DVec3(x, 0.19, z) * 1.3, seed + 2000);
  // A smooth step from plains to mountains: s(w) = (1 + w' / sqrt(1 + w'^2)) / 2, w' = 3 w.
  const double w = 3 * where.value + 0.4, root = std::sqrt(1 + w * w);
  const double share = 0.5 * (1 + w / root), slope = 0.5 * 3 * 1.3 / (root * root * root);
  const DVec3 gradient = hills.gradient + share * ridges.gradient + slope * ridges.value * where.gradient;
  return {hills.value + share * ridges.value - 0.2, gradient.x, gradient.z};
}

}  // namespace

Mesh sheet(std::size_t faces) {
  constexpr double kHalfX = 0.8, kHalfZ = 0.55, kAmplitude = 0.13;
  const double kx = 2.2 * std::numbers::pi, kz = 0.9 * std::numbers::pi;
  return height_field(choose_grid(faces, kHalfX / kHalfZ, {1, 1}), kHalfX, kHalfZ, [&](double x, double z) {
    // A wave along x that leans as z grows, so that its outline is not made of straight lines.
    const double phase = kx * x + 0.8 * z, fall = std::cos(kz * z * 0.5);
    const double y = kAmplitude * std::sin(phase) * (0.6 + 0.4 * fall);
    const double dx = kAmplitude * kx * std::cos(phase) * (0.6 + 0.4 * fall);
    const double dz =
        kAmplitude * (0.8 * std::cos(phase) * (0.6 + 0.4 * fall) - std::sin(phase) * 0.2 * kz * std::sin(kz * z * 0.5));
    return Height{y, dx, dz};
  });
}

Mesh terrain(std::size_t faces, std::uint64_t seed) {
  constexpr double kHalf = 0.7;
  return height_field(choose_grid(faces, 1, {1, 1}), kHalf, kHalf,
                      [&](double x, double z) { return terrain_height(x, z, seed); });
}

}  // namespace limn::procedural
