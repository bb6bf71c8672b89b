#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "limn/refine/patterns/pattern.h"

namespace limn {

/// Up to this level the patterns of both families are made when limn is built.
inline constexpr int kStoredPatternLevel = 6;

/// Where one pattern lies in a table.
struct PatternRange {
  std::uint32_t first_vertex = 0, vertex_count = 0;
  std::uint32_t first_triangle = 0, triangle_count = 0;

  bool operator==(const PatternRange&) const = default;
};

/// All patterns of a family with levels up to one, laid out as a device takes them.
struct PatternTable {
  PatternFamily family = PatternFamily::kNested;
  int max_level = 0;
  std::vector<PatternRange> ranges;        ///< one a base, in order: that of a lower level is the beginning of this one
  std::vector<std::uint32_t> vertices;     ///< pack()ed
  std::vector<PatternTriangle> triangles;  ///< indices count from the pattern's own first vertex
  std::vector<PatternTriangle> mirrored;   ///< the same with their second and third corners swapped

  bool operator==(const PatternTable&) const = default;
};

/// The table of all patterns with levels up to max_level: from what was made at build time where that reaches, made
/// anew beyond. Cost: a copy; beyond kStoredPatternLevel as make_pattern_table(). \pre 0 <= max_level <=
/// kMaxPatternLevel
PatternTable pattern_table(PatternFamily family, int max_level);

/// The same table, made anew: a fifth of a second for both families at level 6, and several times that a level.
PatternTable make_pattern_table(PatternFamily family, int max_level);

/// The pattern of a base: from what was made at build time where that reaches, else made anew.
Pattern find_pattern(PatternFamily family, std::uint32_t base);

/// One pattern of a table. \pre base < table.ranges.size()
Pattern pattern_of(const PatternTable& table, std::uint32_t base);

/// Whether a byte is enough for each of a pattern's indices, and 255 stays free to mark the end of a strip.
constexpr bool fits_byte_indices(const PatternRange& range) {
  return range.vertex_count <= 255;
}

/// What the table takes on a device: 4 bytes a vertex, a byte an index where fits_byte_indices(), else two, both
/// windings. Below 8 KB a family at level 3.
std::size_t device_bytes(const PatternTable& table);

}  // namespace limn
