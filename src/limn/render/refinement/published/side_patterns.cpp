#include "limn/render/refinement/published/side_patterns.h"

#include <algorithm>

namespace limn {
namespace {

void append_as_it_lies(PatternTable& table, const Pattern& pattern, const PatternChoice& choice) {
  table.ranges.push_back(
      {static_cast<std::uint32_t>(table.vertices.size()), static_cast<std::uint32_t>(pattern.vertices.size()),
       static_cast<std::uint32_t>(table.triangles.size()), static_cast<std::uint32_t>(pattern.triangles.size())});
  for (const PatternVertex& v : pattern.vertices)
    table.vertices.push_back(pack(on_face(v, choice.permutation)));
  for (const auto& [a, b, c] : pattern.triangles)
    table.triangles.push_back(choice.mirrored ? PatternTriangle{a, c, b} : PatternTriangle{a, b, c});
}

}  // namespace

PatternTable patterns_of_sides(std::span<const PatternSides> sides) {
  int max_level = 0;
  for (const PatternSides& s : sides)
    max_level = std::max<int>(max_level, *std::max_element(s.begin(), s.end()));
  const PatternTable bases = pattern_table(PatternFamily::kMinimal, max_level);
  PatternTable table{PatternFamily::kMinimal, max_level, {}, {}, {}, {}};
  for (const PatternSides& s : sides) {
    const PatternChoice choice = choose_pattern(PatternFamily::kMinimal, {0, s});
    append_as_it_lies(table, pattern_of(bases, choice.base), choice);
  }
  return table;
}

std::vector<PatternSides> all_sides(int max_level) {
  const auto levels = static_cast<std::uint8_t>(max_level + 1);
  std::vector<PatternSides> sides;
  for (std::uint8_t i = 0; i < levels; ++i) {
    for (std::uint8_t j = 0; j < levels; ++j) {
      for (std::uint8_t k = 0; k < levels; ++k)
        sides.push_back({i, j, k});
    }
  }
  return sides;
}

std::vector<PatternSides> uniform_sides(int max_level) {
  const auto levels = static_cast<std::uint8_t>(max_level + 1);
  std::vector<PatternSides> sides;
  for (std::uint8_t m = 0; m < levels; ++m)
    sides.push_back({m, m, m});
  return sides;
}

}  // namespace limn
