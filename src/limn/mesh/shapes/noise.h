#pragma once

#include <cstdint>

#include "limn/base/vec.h"

namespace limn::procedural {

/// A scalar field's value at a point and its exact derivative there.
struct FieldSample {
  double value = 0;
  DVec3 gradient{0.0};
};

/// Gradient noise: pseudo-random slopes at integer points, joined by quintic weights. Twice continuously
/// differentiable, zero at integer points, about -0.7 to 0.7. Same seed, same field on every machine. \pre |p| < 2^31
FieldSample gradient_noise(const DVec3& p, std::uint64_t seed);

/// How octaves of noise are added up.
struct OctaveOptions {
  int octaves = 6;
  double frequency = 1.0;    ///< of the first octave
  double amplitude = 1.0;    ///< of the first octave
  double lacunarity = 2.03;  ///< frequency from one octave to the next; not 2, so that integer points do not line up
  double gain = 0.5;         ///< amplitude from one octave to the next
};

/// Sum of octaves of gradient noise.
FieldSample octave_noise(const DVec3& p, std::uint64_t seed, const OctaveOptions& options);

/// The same with rounded ridges where the noise changes its sign: mountains rather than hills. 0 or more, mostly below
/// the amplitude.
FieldSample ridged_noise(const DVec3& p, std::uint64_t seed, const OctaveOptions& options);

}  // namespace limn::procedural
