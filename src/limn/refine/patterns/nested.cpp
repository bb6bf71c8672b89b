#include "limn/refine/patterns/nested.h"

#include "limn/refine/grid.h"
#include "limn/refine/patterns/border.h"

namespace limn {
namespace {

/// Points that a finer side has put between the ends of a border triangle's side.
struct Side {
  int c = 0;      ///< which side of the pattern
  int first = 0;  ///< at its first end, in segments of the side
  int count = 1;  ///< segments; 1: none were put
};

void cut(Pattern& pattern, const PatternTriangle& corners, const Side (&sides)[3]) {
  for (std::size_t c = 0; c < 3; ++c) {
    const Side& side = sides[c];
    if (side.count == 1) continue;
    const std::uint16_t opposite = corners[(c + 2) % 3];
    std::uint16_t from = corners[c];
    for (int i = 0; i < side.count; ++i) {
      const bool last = i + 1 == side.count;
      const std::uint16_t to = last ? corners[(c + 1) % 3] : pattern.on_side(side.c, side.first + i + 1);
      const Side part_sides[3] = {Side{}, last ? sides[(c + 1) % 3] : Side{}, i == 0 ? sides[(c + 2) % 3] : Side{}};
      cut(pattern, {from, to, opposite}, part_sides);
      from = to;
    }
    return;
  }
  pattern.triangles.push_back(corners);
}

/// The pattern's vertex at every vertex of the grid; adds those inside.
std::vector<std::uint16_t> name_vertices(Pattern& pattern, const Grid& grid, const int (&step)[3]) {
  std::vector<std::uint16_t> names(grid.vertices.size());
  for (int c = 0; c < 3; ++c) {
    for (int q = 0; q < grid.segments(); ++q)
      names[grid.on_side(c, q)] = pattern.on_side(c, q * step[c]);
  }
  const int finer = pattern.config.sides[0] - grid.level;
  for (const std::uint32_t v : grid.interior) {
    const GridVertex& g = grid.vertices[v];
    names[v] = static_cast<std::uint16_t>(pattern.vertices.size());
    pattern.vertices.push_back(
        {static_cast<std::uint16_t>(g.j << finer), static_cast<std::uint16_t>(g.k << finer), pattern.config.sides[0]});
  }
  return names;
}

}  // namespace

Pattern make_nested_pattern(const PatternConfig& config) {
  Pattern pattern = pattern_border(config);
  const Grid grid = make_grid(config.inner);
  const int n = grid.segments();
  int step[3];  // segments of each side to one of the grid
  for (std::size_t c = 0; c < 3; ++c)
    step[c] = 1 << (config.sides[c] - config.inner);
  const std::vector<std::uint16_t> names = name_vertices(pattern, grid, step);
  for (const auto& t : grid.triangles) {
    const GridVertex& first = grid.vertices[t[0]];
    const bool upward = grid.vertices[t[1]].k == first.k;
    Side sides[3];
    // Only triangles that point the way the whole does have sides on the border.
    if (upward && first.k == 0) sides[0] = {0, first.j * step[0], step[0]};
    if (upward && first.j + first.k == n - 1) sides[1] = {1, first.k * step[1], step[1]};
    if (upward && first.j == 0) sides[2] = {2, (n - 1 - first.k) * step[2], step[2]};
    cut(pattern, {names[t[0]], names[t[1]], names[t[2]]}, sides);
  }
  return pattern;
}

}  // namespace limn
