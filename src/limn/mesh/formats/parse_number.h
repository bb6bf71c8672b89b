#pragma once

#include <charconv>
#include <limits>
#include <string_view>
#include <system_error>

namespace limn::formats {

/// Parses the decimal number at the start of `text`, rounded correctly to float: what std::to_chars wrote comes back
/// bit for bit. A leading '+' is taken; too small gives 0 and too large infinity, with the number's sign.
/// Gives the number of characters used, 0 when there is no number. Does not depend on the locale.
inline std::size_t parse_float(std::string_view text, float& value) {
  const char* const begin = text.data();
  const char* const end = begin + text.size();
  const char* first = begin;
  if (first != end && *first == '+') {
    ++first;
    if (first != end && (*first == '-' || *first == '+')) return 0;
  }
  const auto [last, code] = std::from_chars(first, end, value);
  if (code == std::errc::invalid_argument) return 0;
  const auto used = static_cast<std::size_t>(last - begin);
  if (code == std::errc()) return used;
  // Out of range: from_chars leaves the value alone and does not tell which end was passed. A double may still hold it.
  double wide = 0.0;
  if (std::from_chars(first, end, wide).ec == std::errc()) {
    value = wide > 1.0    ? std::numeric_limits<float>::infinity()
            : wide < -1.0 ? -std::numeric_limits<float>::infinity()
                          : static_cast<float>(wide);
    return used;
  }
  const std::string_view token(first, static_cast<std::size_t>(last - first));
  const std::size_t exponent = token.find_first_of("eE");
  const bool small = exponent != std::string_view::npos ? token.substr(exponent).find('-') != std::string_view::npos
                                                        : token.find_first_of("123456789") > token.find('.');
  value = small ? 0.0f : std::numeric_limits<float>::infinity();
  if (token.starts_with('-')) value = -value;
  return used;
}

}  // namespace limn::formats
