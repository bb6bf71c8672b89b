#pragma once

#include <cmath>
#include <cstdint>

#include "limn/base/vec.h"

namespace limn {

/// A small seeded generator (SplitMix64): the same seed gives the same numbers on every machine and compiler.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  /// The next 64 uniform bits.
  std::uint64_t next() {
    state_ += 0x9e3779b97f4a7c15ull;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
  }

  /// Uniform in [0, 1), a multiple of 2^-53.
  double uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }

  /// Uniform in [low, high).
  double uniform(double low, double high) { return low + (high - low) * uniform(); }

  /// Uniform over 0 … bound-1 (bias below 2^-32 for bounds up to 2^32). \pre bound > 0
  std::uint64_t below(std::uint64_t bound) { return next() % bound; }

  /// A unit vector, uniform over the sphere.
  Vec3 direction() {
    const double z = uniform(-1.0, 1.0);
    const double phi = uniform(0.0, 6.283185307179586);
    const double r = std::sqrt(1.0 - z * z);
    return Vec3(static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)), static_cast<float>(z));
  }

 private:
  std::uint64_t state_;
};

}  // namespace limn
