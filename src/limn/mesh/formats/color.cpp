#include "limn/mesh/formats/color.h"

#include <algorithm>
#include <cmath>

namespace limn::formats {

const std::array<float, 256>& linear_of_srgb_byte() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> values{};
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double srgb = static_cast<double>(i) / 255.0;
      values[i] = static_cast<float>(srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4));
    }
    return values;
  }();
  return table;
}

std::optional<std::uint8_t> srgb_byte_of(float linear) {
  const std::array<float, 256>& table = linear_of_srgb_byte();
  const auto found = std::lower_bound(table.begin(), table.end(), linear);
  if (found == table.end() || *found != linear) return std::nullopt;
  return static_cast<std::uint8_t>(found - table.begin());
}

}  // namespace limn::formats
