#include "limn/refine/patterns/table.h"

#include <cassert>

namespace limn {

PatternTable make_pattern_table(PatternFamily family, int max_level) {
  assert(0 <= max_level && max_level <= kMaxPatternLevel);
  PatternTable table{family, max_level, {}, {}, {}, {}};
  for (std::uint32_t base = 0; base < pattern_count(family, max_level); ++base) {
    const Pattern pattern = make_pattern(family, pattern_config(family, base));
    table.ranges.push_back(
        {static_cast<std::uint32_t>(table.vertices.size()), static_cast<std::uint32_t>(pattern.vertices.size()),
         static_cast<std::uint32_t>(table.triangles.size()), static_cast<std::uint32_t>(pattern.triangles.size())});
    for (const PatternVertex& v : pattern.vertices)
      table.vertices.push_back(pack(v));
    for (const auto& [a, b, c] : pattern.triangles) {
      table.triangles.push_back({a, b, c});
      table.mirrored.push_back({a, c, b});
    }
  }
  return table;
}

Pattern pattern_of(const PatternTable& table, std::uint32_t base) {
  const PatternRange& range = table.ranges[base];
  Pattern pattern;
  pattern.config = pattern_config(table.family, base);
  for (std::uint32_t n = 0; n < range.vertex_count; ++n)
    pattern.vertices.push_back(unpack(table.vertices[range.first_vertex + n]));
  const auto first = table.triangles.begin() + range.first_triangle;
  pattern.triangles.assign(first, first + range.triangle_count);
  return pattern;
}

std::size_t device_bytes(const PatternTable& table) {
  std::size_t bytes = 4 * table.vertices.size();
  for (const PatternRange& range : table.ranges)
    bytes += std::size_t{2} * 3 * range.triangle_count * (fits_byte_indices(range) ? 1 : 2);
  return bytes;
}

}  // namespace limn
