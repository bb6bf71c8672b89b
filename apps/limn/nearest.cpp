#include "nearest.h"

#include <algorithm>
#include <fmt/format.h>
#include <vector>

namespace limn::cli {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  // Three rows of the table: the one being filled, the one above, and the one above that, which swaps look back to.
  std::vector<std::size_t> before(b.size() + 1), above(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j)
    above[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = above[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, replaced});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before.swap(above);
    above.swap(row);
  }
  return above[b.size()];
}

std::string_view nearest(std::string_view word, std::span<const std::string_view> known) {
  const auto distance = [word](std::string_view other) -> std::size_t {
    return word.size() > 1 && other.starts_with(word) ? 0 : edit_distance(word, other);
  };
  return *std::min_element(known.begin(), known.end(),
                           [&](std::string_view a, std::string_view b) { return distance(a) < distance(b); });
}

std::string suggest(std::string_view word, std::span<const std::string_view> known) {
  const std::string_view best = nearest(word, known);
  const bool near = best.starts_with(word) || edit_distance(word, best) <= 1 + best.size() / 4;
  return near ? fmt::format("did you mean '{}'?", best) : fmt::format("the nearest is '{}'", best);
}

}  // namespace limn::cli
