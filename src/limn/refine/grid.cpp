#include "limn/refine/grid.h"

#include <algorithm>
#include <bit>
#include <cassert>

namespace limn {
namespace {

GridVertex make_vertex(const Grid& grid, int j, int k) {
  const int n = grid.segments();
  const int i = n - j - k;
  // The largest step that divides all three coordinates is that of the refinement in which the vertex appears.
  const unsigned all = static_cast<unsigned>(i) | static_cast<unsigned>(j) | static_cast<unsigned>(k);
  const int step = 1 << std::countr_zero(all);
  const std::uint32_t self = grid.index(j, k);
  GridVertex vertex{static_cast<std::uint16_t>(i),
                    static_cast<std::uint16_t>(j),
                    static_cast<std::uint16_t>(k),
                    static_cast<std::uint8_t>(grid.level - std::countr_zero(all)),
                    {self, self}};
  if (vertex.level == 0) return vertex;
  // Two of the coordinates are odd multiples of the step: the parents lie a step away along the side these span.
  const auto odd = [step](int coordinate) { return (coordinate / step) % 2 != 0; };
  const int dj = odd(j) ? step : 0;
  const int dk = !odd(k) ? 0 : odd(j) ? -step : step;
  vertex.parents[0] = grid.index(j + dj, k + dk);
  vertex.parents[1] = grid.index(j - dj, k - dk);
  return vertex;
}

}  // namespace

Grid make_grid(int level) {
  assert(0 <= level && level <= 8);
  Grid grid;
  grid.level = level;
  const int n = grid.segments();
  for (int k = 0; k <= n; ++k) {
    for (int j = 0; j <= n - k; ++j) {
      grid.vertices.push_back(make_vertex(grid, j, k));
      if (j > 0 && k > 0 && j + k < n) grid.interior.push_back(grid.index(j, k));
      if (j + k == n) continue;
      grid.triangles.push_back({grid.index(j, k), grid.index(j + 1, k), grid.index(j, k + 1)});
      if (j + k < n - 1)
        grid.triangles.push_back({grid.index(j + 1, k), grid.index(j + 1, k + 1), grid.index(j, k + 1)});
    }
  }
  std::stable_sort(grid.interior.begin(), grid.interior.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return grid.vertices[a].level < grid.vertices[b].level; });
  return grid;
}

}  // namespace limn
