#pragma once

#include <array>
#include <cstdint>
#include <optional>

namespace limn::formats {

/// The linear value of each sRGB byte: what files that hold colours as bytes mean by them.
const std::array<float, 256>& linear_of_srgb_byte();

/// The byte whose linear value is exactly `linear`; nothing when there is none.
std::optional<std::uint8_t> srgb_byte_of(float linear);

}  // namespace limn::formats
