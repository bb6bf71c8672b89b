#include "limn/refine/patterns/stored.h"

#include <cassert>

namespace limn {

PatternTable pattern_table(PatternFamily family, int max_level) {
  assert(0 <= max_level && max_level <= kMaxPatternLevel);
  if (max_level > kStoredPatternLevel) return make_pattern_table(family, max_level);
  const StoredPatterns stored = stored_patterns(family);
  PatternTable table{family, max_level, {}, {}, {}, {}};
  const auto ranges = stored.ranges.first(pattern_count(family, max_level));
  const auto vertices = stored.vertices.first(ranges.back().first_vertex + ranges.back().vertex_count);
  const auto triangles = stored.triangles.first(ranges.back().first_triangle + ranges.back().triangle_count);
  table.ranges.assign(ranges.begin(), ranges.end());
  table.vertices.assign(vertices.begin(), vertices.end());
  table.triangles.assign(triangles.begin(), triangles.end());
  table.mirrored.reserve(triangles.size());
  for (const auto& [a, b, c] : triangles)
    table.mirrored.push_back({a, c, b});
  return table;
}

Pattern find_pattern(PatternFamily family, std::uint32_t base) {
  const PatternConfig config = pattern_config(family, base);
  if (config.sides[0] > kStoredPatternLevel) return make_pattern(family, config);
  const StoredPatterns stored = stored_patterns(family);
  const PatternRange& range = stored.ranges[base];
  Pattern pattern;
  pattern.config = config;
  pattern.vertices.reserve(range.vertex_count);
  for (const std::uint32_t word : stored.vertices.subspan(range.first_vertex, range.vertex_count))
    pattern.vertices.push_back(unpack(word));
  const auto triangles = stored.triangles.subspan(range.first_triangle, range.triangle_count);
  pattern.triangles.assign(triangles.begin(), triangles.end());
  return pattern;
}

}  // namespace limn
