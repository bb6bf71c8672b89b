#include "gate.h"

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

/// The comparator the text begins with, taken off it; nullptr when there is none.
Comparator take_comparator(std::string_view& text) {
  for (const auto& [sign, comparator] : kComparators) {
    if (!text.starts_with(sign)) continue;
    text.remove_prefix(sign.size());
    return comparator;
  }
  return nullptr;
}

/// A number, divided by 100 where % follows.
Result<double> parse_limit(std::string_view text) {
  const bool percent = text.ends_with('%');
  if (percent) text.remove_suffix(1);
  return parse_number(text).map([percent](double value) { return percent ? value / 100.0 : value; });
}

/// "mean_px, p95_px, max_px or iou"
std::string listed(std::span<const std::string_view> names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " or " : ", ") + std::string(names[i]);
  return text;
}

}  // namespace

Result<Gate> parse_gate(std::string_view text, std::span<const std::string_view> figures) {
  std::string plain;
  std::copy_if(text.begin(), text.end(), std::back_inserter(plain), [](char c) { return c != ' '; });
  std::string_view rest = plain;
  const auto figure =
      std::find_if(figures.begin(), figures.end(), [&](std::string_view name) { return rest.starts_with(name); });
  if (figure != figures.end()) rest.remove_prefix(figure->size());
  const Comparator comparator = figure != figures.end() ? take_comparator(rest) : nullptr;
  const Result<double> limit = parse_limit(rest);
  if (comparator == nullptr || !limit) {
    return fail(ErrorCode::kInvalidArgument,
                fmt::format("takes {}, then > >= < or <=, then a number, not '{}'", listed(figures), text),
                fmt::format("for example --fail-if '{}>0.5'", figures.front()));
  }
  return Gate{std::string(text), static_cast<std::size_t>(figure - figures.begin()), comparator, *limit};
}

std::vector<std::string> tripped(std::span<const Gate> gates, std::span<const double> values) {
  std::vector<std::string> texts;
  for (const Gate& gate : gates) {
    if (gate.holds(values[gate.figure], gate.limit)) texts.push_back(gate.text);
  }
  return texts;
}

}  // namespace limn::cli
