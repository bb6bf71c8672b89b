#pragma once

#include <cstdint>

namespace limn {

/// A stored sRGB byte as linear light, 0 … 1: from a table.
float linear_of_srgb(std::uint8_t stored);

/// Linear light as an sRGB value, 0 … 1; what lies outside 0 … 1 is clamped, NaN gives 0.
float srgb_of_linear(float linear);

}  // namespace limn
