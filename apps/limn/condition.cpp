#include "condition.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <utility>

#include "parse_value.h"

namespace limn::cli {
namespace {

using Comparator = bool (*)(double, double);
/// Longer ones first, so that ">=" is not read as ">".
constexpr std::array<std::pair<std::string_view, Comparator>, 4> kComparators{
    {{">=", [](double a, double b) { return a >= b; }},
     {"<=", [](double a, double b) { return a <= b; }},
     {">", [](double a, double b) { return a > b; }},
     {"<", [](double a, double b) { return a < b; }}}};

/// "a, b or c".
std::string listed(std::span<const std::string_view> names) {
  std::string text(names[0]);
  for (std::size_t i = 1; i < names.size(); ++i)
    text += fmt::format("{}{}", i + 1 == names.size() ? " or " : ", ", names[i]);
  return text;
}

Result<double> parse_limit(std::string_view text) {
  const bool percent = text.ends_with('%');
  if (percent) text.remove_suffix(1);
  return parse_number(text).map([percent](double value) { return percent ? value / 100.0 : value; });
}

}  // namespace

Result<Condition> parse_condition(std::string_view text, std::span<const std::string_view> names,
                                  std::string_view example) {
  Condition condition;
  condition.text = text;
  std::string plain;
  std::copy_if(text.begin(), text.end(), std::back_inserter(plain), [](char c) { return c != ' '; });
  std::string_view rest = plain;
  const auto name =
      std::find_if(names.begin(), names.end(), [&](std::string_view start) { return rest.starts_with(start); });
  if (name != names.end()) {
    condition.figure = static_cast<std::size_t>(name - names.begin());
    rest.remove_prefix(name->size());
    const auto found = std::find_if(kComparators.begin(), kComparators.end(),
                                    [&](const auto& entry) { return rest.starts_with(entry.first); });
    if (found != kComparators.end()) {
      condition.compare = found->second;
      rest.remove_prefix(found->first.size());
    }
  }
  const Result<double> limit = parse_limit(rest);
  if (condition.compare == nullptr || !limit) {
    return fail(ErrorCode::kInvalidArgument,
                fmt::format("takes {}, then > >= < or <=, then a number, not '{}'", listed(names), text),
                fmt::format("for example --fail-if '{}'", example));
  }
  condition.limit = *limit;
  return condition;
}

}  // namespace limn::cli
