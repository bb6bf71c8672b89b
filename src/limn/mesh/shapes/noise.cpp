#include "limn/mesh/shapes/noise.h"

#include <cmath>
namespace limn::procedural {
namespace {

std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}

/// The slope an integer point's hash stands for: each component uniform in [-1, 1).
DVec3 slope_of(std::uint64_t hash) {
  const auto component = [](std::uint64_t bits) {
    return static_cast<double>(static_cast<std::int64_t>(bits & 0x1fffff)) * 0x1.0p-20 - 1.0;
  };
  return {component(hash), component(hash >> 21), component(hash >> 42)};
}

std::uint64_t join(std::uint64_t hash, std::int64_t coordinate) {
  return mix(hash + 0x9e3779b97f4a7c15ull * static_cast<std::uint64_t>(coordinate));
}

std::int64_t floor_of(double x) {
  const auto whole = static_cast<std::int64_t>(x);  // towards zero
  return whole - (x < static_cast<double>(whole) ? 1 : 0);
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
  const std::int64_t cell[3] = {floor_of(p.x), floor_of(p.y), floor_of(p.z)};
  const DVec3 f = p - DVec3(cell[0], cell[1], cell[2]);
  const Fade fx = fade(f.x), fy = fade(f.y), fz = fade(f.z);
  FieldSample sum;
  for (int i = 0; i < 2; ++i) {
    const std::uint64_t hash_x = join(seed, cell[0] + i);
    const double wx = i ? fx.weight : 1 - fx.weight, dx = i ? fx.slope : -fx.slope;
    for (int j = 0; j < 2; ++j) {
      const std::uint64_t hash_xy = join(hash_x, cell[1] + j);
      const double wy = j ? fy.weight : 1 - fy.weight, dy = j ? fy.slope : -fy.slope;
      for (int k = 0; k < 2; ++k) {
        const double wz = k ? fz.weight : 1 - fz.weight, dz = k ? fz.slope : -fz.slope;
        const DVec3 slope = slope_of(join(hash_xy, cell[2] + k));
        const double height = slope.x * (f.x - i) + slope.y * (f.y - j) + slope.z * (f.z - k);
        sum.value += wx * wy * wz * height;
        sum.gradient += wx * wy * wz * slope + height * DVec3(dx * wy * wz, wx * dy * wz, wx * wy * dz);
      }
    }
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
  constexpr double kRounding = 0.15;  // where |noise| is below this, the ridge is round
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
