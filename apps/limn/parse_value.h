#pragma once

#include <cstdint>
#include <limits>
#include <string_view>

#include "limn/base/result.h"
#include "limn/base/vec.h"

/// Values as a user types them. Every function reads the whole text or gives kInvalidArgument saying what was expected;
/// none accepts NaN, infinity, trailing letters or blanks. Independent of the locale.
namespace limn::cli {

/// Which numbers an option takes.
struct Range {
  double low = std::numeric_limits<double>::lowest();
  double high = std::numeric_limits<double>::max();
  bool open_low = false;  ///< `low` itself is not allowed
  bool open_high = false;
};

Result<double> parse_number(std::string_view text, const Range& range = {});
Result<std::uint64_t> parse_count(std::string_view text, std::uint64_t low, std::uint64_t high);

/// "x,y,z".
Result<Vec3> parse_point(std::string_view text);

/// "azimuth,elevation" in degrees; the elevation from -90 to 90.
Result<Vec2> parse_view(std::string_view text);

struct Size {
  int width = 0;
  int height = 0;
};
/// "WxH", or "N" for a square; each from 1 to 16384.
Result<Size> parse_size(std::string_view text);

/// "A:B", both above 0, as A / B.
Result<double> parse_ratio(std::string_view text);

/// A name, #rgb, #rrggbb, #rrggbbaa, or "transparent"; sRGB 0 … 1.
Result<Vec4> parse_color(std::string_view text);

}  // namespace limn::cli
