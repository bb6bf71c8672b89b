#include "limn/asset/position_codec.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace limn::asset {
namespace {

constexpr std::uint32_t kSign = 0x80000000u;

std::uint32_t ordered(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  return (bits & kSign) != 0 ? ~bits : bits | kSign;
}

float from_ordered(std::uint32_t ordered) {
  return std::bit_cast<float>((ordered & kSign) != 0 ? ordered & ~kSign : ~ordered);
}

double power_of_ten(int digits) {
  double power = 1.0;
  for (int i = 0; i < digits; ++i)
    power *= 10.0;
  return power;
}

}  // namespace

WholeNumbers::WholeNumbers(int digits) : digits_(digits), scale_(power_of_ten(digits)) {}

int WholeNumbers::digits_of(std::span<const Vec3> positions) {
  int digits = 0;
  double largest = 0.0;
  for (const Vec3& p : positions) {
    for (int axis = 0; axis < 3; ++axis) {
      // What has few digits has them with more digits, too: those found so far stay good, but for their size.
      largest = std::max(largest, std::abs(static_cast<double>(p[axis])));
      while (digits <= kMostDigits && !WholeNumbers(digits).keeps(p[axis]))
        ++digits;
      if (digits > kMostDigits || largest * power_of_ten(digits) > static_cast<double>(kMostDecimal)) return -1;
    }
  }
  return digits;
}

bool WholeNumbers::keeps(float value) const {
  float again = 0.0f;
  if (std::abs(static_cast<double>(value) * scale_) > static_cast<double>(kMostDecimal)) return false;
  return back(of(value), again) && std::bit_cast<std::uint32_t>(again) == std::bit_cast<std::uint32_t>(value);
}

std::int64_t WholeNumbers::of(float value) const {
  return digits_ < 0 ? std::int64_t{ordered(value)} : std::llround(static_cast<double>(value) * scale_);
}

bool WholeNumbers::back(std::int64_t whole, float& value) const {
  if (digits_ >= 0) {
    if (whole > kMostDecimal || whole < -kMostDecimal) return false;
    value = static_cast<float>(static_cast<double>(whole) / scale_);
    return true;
  }
  if (whole < 0 || whole > std::int64_t{std::numeric_limits<std::uint32_t>::max()}) return false;
  value = from_ordered(static_cast<std::uint32_t>(whole));
  return std::isfinite(value);
}

std::int64_t WholeNumbers::guess(float a, float b, float c) const {
  if (digits_ >= 0) return of(a) + of(b) - of(c);
  constexpr double kMost = std::numeric_limits<float>::max();
  const double sum = static_cast<double>(a) + static_cast<double>(b) - static_cast<double>(c);
  return std::int64_t{ordered(static_cast<float>(sum > kMost ? kMost : sum < -kMost ? -kMost : sum))};
}

}  // namespace limn::asset
