#include "parse_value.h"

#include <array>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <string>
#include <utility>
#include <vector>

namespace limn::cli {
namespace {

constexpr int kLargestSide = 16384;

constexpr std::array<std::pair<std::string_view, std::string_view>, 14> kColors{{{"white", "#ffffff"},
                                                                                 {"black", "#000000"},
                                                                                 {"gray", "#808080"},
                                                                                 {"grey", "#808080"},
                                                                                 {"silver", "#c0c0c0"},
                                                                                 {"red", "#e02020"},
                                                                                 {"green", "#209040"},
                                                                                 {"blue", "#2050c0"},
                                                                                 {"navy", "#102040"},
                                                                                 {"yellow", "#f0d020"},
                                                                                 {"orange", "#f08020"},
                                                                                 {"beige", "#f4efe4"},
                                                                                 {"sky", "#cfe2f3"},
                                                                                 {"transparent", "#ffffff00"}}};

std::string describe(const Range& range) {
  const bool has_low = range.low > std::numeric_limits<double>::lowest();
  const bool has_high = range.high < std::numeric_limits<double>::max();
  if (has_low && has_high && !range.open_low && !range.open_high) {
    return fmt::format("a number from {:g} to {:g}", range.low, range.high);
  }
  std::string text = "a number";
  if (has_low) text += fmt::format(" {} {:g}", range.open_low ? "above" : "of at least", range.low);
  if (has_low && has_high) text += " and";
  if (has_high) text += fmt::format(" {} {:g}", range.open_high ? "below" : "of at most", range.high);
  return text;
}

tl::unexpected<Error> expected(std::string_view what, std::string_view text) {
  return fail(ErrorCode::kInvalidArgument, fmt::format("takes {}, not '{}'", what, text));
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t at = 0;;) {
    const std::size_t end = text.find(separator, at);
    parts.push_back(text.substr(at, end - at));
    if (end == std::string_view::npos) return parts;
    at = end + 1;
  }
}

/// The numbers of a comma-separated list of a given length; each must also be a finite float.
Result<std::vector<float>> parse_list(std::string_view text, std::size_t length, std::string_view what) {
  std::vector<float> values;
  for (const std::string_view part : split(text, ',')) {
    const auto value = parse_number(part);
    if (!value || !std::isfinite(static_cast<float>(*value))) return expected(what, text);
    values.push_back(static_cast<float>(*value));
  }
  if (values.size() != length) return expected(what, text);
  return values;
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

}  // namespace

Result<double> parse_number(std::string_view text, const Range& range) {
  const std::string_view digits = text.starts_with('+') ? text.substr(1) : text;
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool read = error == std::errc{} && end == digits.data() + digits.size() && !digits.starts_with("+-");
  const bool inside = read && std::isfinite(value) && value >= range.low && value <= range.high &&
                      !(range.open_low && value == range.low) && !(range.open_high && value == range.high);
  if (!inside) return expected(describe(range), text);
  return value;
}

Result<std::uint64_t> parse_count(std::string_view text, std::uint64_t low, std::uint64_t high) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc{} && end == text.data() + text.size() && value >= low && value <= high) return value;
  const bool bounded = high < std::numeric_limits<std::uint64_t>::max();
  return expected(bounded ? fmt::format("a whole number from {} to {}", low, high) : "a whole number", text);
}

Result<Vec3> parse_point(std::string_view text) {
  return parse_list(text, 3, "three numbers x,y,z").map([](const std::vector<float>& v) {
    return Vec3(v[0], v[1], v[2]);
  });
}

Result<Vec2> parse_view(std::string_view text) {
  constexpr std::string_view kWhat = "two angles azimuth,elevation in degrees, the second from -90 to 90";
  const auto values = parse_list(text, 2, kWhat);
  if (!values) return tl::unexpected(values.error());
  if (std::abs((*values)[1]) > 90.0f) return expected(kWhat, text);
  return Vec2((*values)[0], (*values)[1]);
}

Result<Size> parse_size(std::string_view text) {
  const std::string what = fmt::format("a size WxH in pixels, each from 1 to {}", kLargestSide);
  const std::vector<std::string_view> parts = split(text, 'x');
  if (parts.size() > 2) return expected(what, text);
  const auto width = parse_count(parts.front(), 1, kLargestSide);
  const auto height = parse_count(parts.back(), 1, kLargestSide);
  if (!width || !height) return expected(what, text);
  return Size{static_cast<int>(*width), static_cast<int>(*height)};
}

Result<double> parse_ratio(std::string_view text) {
  const std::vector<std::string_view> parts = split(text, ':');
  constexpr Range kPositive{0.0, std::numeric_limits<double>::max(), true, false};
  const auto first = parse_number(parts.front(), kPositive);
  const auto second = parse_number(parts.back(), kPositive);
  const bool read = parts.size() == 2 && first && second;
  if (!read || !std::isnormal(*first / *second)) return expected("a ratio A:B of numbers above 0", text);
  return *first / *second;
}

Result<Vec4> parse_color(std::string_view text) {
  std::string_view hex = text;
  for (const auto& [name, value] : kColors) {
    if (text == name) hex = value;
  }
  std::vector<int> digits;
  for (const char c : hex.substr(hex.empty() ? 0 : 1))
    digits.push_back(hex_digit(c));
  bool good = hex.starts_with('#') && (digits.size() == 3 || digits.size() == 6 || digits.size() == 8);
  for (const int digit : digits)
    good = good && digit >= 0;
  if (!good) return expected("a colour name, #rgb, #rrggbb, #rrggbbaa or transparent", text);
  if (digits.size() == 3) digits = {digits[0], digits[0], digits[1], digits[1], digits[2], digits[2]};
  if (digits.size() == 6) digits.insert(digits.end(), {15, 15});
  const auto channel = [&](std::size_t i) {
    return static_cast<float>(digits[2 * i] * 16 + digits[2 * i + 1]) / 255.0f;
  };
  return Vec4(channel(0), channel(1), channel(2), channel(3));
}

}  // namespace limn::cli
