#include "gate.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <utility>

#include "parse_value.h"

namespace limn::cli {
namespace {

constexpr std::array<std::pair<std::string_view, double OutlineError::*>, 4> kFigures{
    {{"mean_px", &OutlineError::mean_px},
     {"p95_px", &OutlineError::p95_px},
     {"max_px", &OutlineError::max_px},
     {"iou", &OutlineError::iou}}};

using Comparator = bool (*)(double, double);
/// Longer ones first, so that ">=" is not read as ">".
constexpr std::array<std::pair<std::string_view, Comparator>, 4> kComparators{
    {{">=", [](double a, double b) { return a >= b; }},
     {"<=", [](double a, double b) { return a <= b; }},
     {">", [](double a, double b) { return a > b; }},
     {"<", [](double a, double b) { return a < b; }}}};

/// The value of the entry whose word the text begins with, and the rest; nullptr when there is none.
template <class Table>
auto take(const Table& table, std::string_view& text) -> decltype(&table[0].second) {
  for (const auto& entry : table) {
    if (!text.starts_with(entry.first)) continue;
    text.remove_prefix(entry.first.size());
    return &entry.second;
  }
  return nullptr;
}

}  // namespace

Result<Gate> parse_gate(std::string_view text) {
  std::string plain;
  std::copy_if(text.begin(), text.end(), std::back_inserter(plain), [](char c) { return c != ' '; });
  std::string_view rest = plain;
  const auto* const figure = take(kFigures, rest);
  const auto* const comparator = figure != nullptr ? take(kComparators, rest) : nullptr;
  const Result<double> limit = parse_number(rest);
  if (figure == nullptr || comparator == nullptr || !limit) {
    return fail(ErrorCode::kInvalidArgument,
                fmt::format("takes mean_px, p95_px, max_px or iou, then > >= < or <=, then a number, not '{}'", text),
                "for example --fail-if 'mean_px>0.5'");
  }
  return Gate{std::string(text), *figure, *comparator, *limit};
}

bool trips(const Gate& gate, const OutlineError& error) {
  return gate.holds(error.*gate.figure, gate.limit);
}

}  // namespace limn::cli
