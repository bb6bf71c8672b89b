#include "limn/mesh/shapes_noise.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace limn::procedural {
namespace {

std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}

/// The slope at an integer point: each component uniform in [-1, 1).
DVec3 slope_at(std::int64_t x, std::int64_t y, std::int64_t z, std::uint64_t seed) {
  std::uint64_t h = mix(seed + 0x9e3779b97f4a7c15ull * static_cast<std::uint64_t>(x));
  h = mix(h + 0xc2b2ae3d27d4eb4full * static_cast<std::uint64_t>(y));
  h = mix(h + 0x165667b19e3779f9ull * static_cast<std::uint64_t>(z));
  const auto component = [](std::uint64_t bits) { return static_cast<double>(bits & 0x1fffff) * 0x1.0p-20 - 1.0; };
  return {component(h), component(h >> 21), component(h >> 42)};
}

/// Weight of the upper neighbour, and its derivative.
struct Fade {
  double weight, slope;
};

Fade fade(double t) {
  return {t * t * t * (t * (t * 6 - 15) + 10), 30 * t * t * (t - 1) * (t - 1)};
}

}  // namespace

FieldSample gradient_noise(const DVec3& p, std::uint64_t seed) {
  const DVec3 cell(std::floor(p.x), std::floor(p.y), std::floor(p.z));
  const DVec3 f = p - cell;
  const Fade fx = fade(f.x), fy = fade(f.y), fz = fade(f.z);
  FieldSample sum;
  for (int corner = 0; corner < 8; ++corner) {
    const int i = corner & 1, j = (corner >> 1) & 1, k = corner >> 2;
    const double wx = i ? fx.weight : 1 - fx.weight, dx = i ? fx.slope : -fx.slope;
    const double wy = j ? fy.weight : 1 - fy.weight, dy = j ? fy.slope : -fy.slope;
    const double wz = k ? fz.weight : 1 - fz.weight, dz = k ? fz.slope : -fz.slope;
    const DVec3 slope = slope_at(static_cast<std::int64_t>(cell.x) + i, static_cast<std::int64_t>(cell.y) + j,
                                 static_cast<std::int64_t>(cell.z) + k, seed);
    const double height = glm::dot(slope, f - DVec3(i, j, k));
    sum.value += wx * wy * wz * height;
    sum.gradient += wx * wy * wz * slope + height * DVec3(dx * wy * wz, wx * dy * wz, wx * wy * dz);
  }
  return sum;
}

FieldSample octave_noise(const DVec3& p, std::uint64_t seed, const OctaveOptions& options) {
  FieldSample sum;
  double frequency = options.frequency, amplitude = options.amplitude;
  for (int octave = 0; octave < options.octaves; ++octave) {
    const FieldSample one = gradient_noise(p * frequency, mix(seed + static_cast<std::uint64_t>(octave)));
    sum.value += amplitude * one.value;
    sum.gradient += amplitude * frequency * one.gradient;
    frequency *= options.lacunarity;
    amplitude *= options.gain;
  }
  return sum;
}

FieldSample ridged_noise(const DVec3& p, std::uint64_t seed, const OctaveOptions& options) {
  constexpr double kRounding = 0.08;  // where |noise| is below this, the ridge is round
  FieldSample sum;
  double frequency = options.frequency, amplitude = options.amplitude;
  for (int octave = 0; octave < options.octaves; ++octave) {
    const FieldSample one = gradient_noise(p * frequency, mix(seed + static_cast<std::uint64_t>(octave)));
    const double size = std::sqrt(one.value * one.value + kRounding * kRounding);
    const double ridge = 1 - size;
    sum.value += amplitude * ridge * ridge;
    sum.gradient -= amplitude * frequency * 2 * ridge * (one.value / size) * one.gradient;
    frequency *= options.lacunarity;
    amplitude *= options.gain;
  }
  return sum;
}

}  // namespace limn::procedural
