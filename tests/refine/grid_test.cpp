#include "limn/refine/grid.h"

#include <gtest/gtest.h>
#include <set>

namespace limn {
namespace {

TEST(Grid, HasEveryDyadicVertexOnceAndTrianglesThatTileTheParameterTriangle) {
  for (int m = 0; m <= 8; ++m) {
    const Grid grid = make_grid(m);
    const int n = 1 << m;
    ASSERT_EQ(grid.vertices.size(), static_cast<std::size_t>((n + 1) * (n + 2) / 2));
    ASSERT_EQ(grid.triangles.size(), std::size_t{1} << (2 * m));
    std::set<std::pair<int, int>> seen;
    for (std::uint32_t v = 0; v < grid.vertices.size(); ++v) {
      const GridVertex& g = grid.vertices[v];
      EXPECT_EQ(g.i + g.j + g.k, n);
      EXPECT_EQ(grid.index(g.j, g.k), v);
      seen.insert({g.j, g.k});
    }
    EXPECT_EQ(seen.size(), grid.vertices.size());
    for (const auto& t : grid.triangles) {
      const GridVertex& a = grid.vertices[t[0]];
      const GridVertex& b = grid.vertices[t[1]];
      const GridVertex& c = grid.vertices[t[2]];
      // Each has one unit of area with the same sign: 4^m of them tile the whole.
      EXPECT_EQ((b.j - a.j) * (c.k - a.k) - (b.k - a.k) * (c.j - a.j), 1);
    }
  }
}

TEST(Grid, NamesAsParentsTheEndsOfTheEdgeThatAVertexHalves) {
  const Grid grid = make_grid(5);
  for (const GridVertex& g : grid.vertices) {
    const GridVertex& a = grid.vertices[g.parents[0]];
    const GridVertex& b = grid.vertices[g.parents[1]];
    EXPECT_EQ(a.i + b.i, 2 * g.i);
    EXPECT_EQ(a.j + b.j, 2 * g.j);
    if (g.level == 0) continue;
    EXPECT_LT(a.level, g.level);
    EXPECT_LT(b.level, g.level);
    // Along one side of the triangle, a step of the vertex's own level away.
    const int step = 1 << (5 - g.level);
    const int moves[3] = {std::abs(a.i - g.i), std::abs(a.j - g.j), std::abs(a.k - g.k)};
    EXPECT_EQ(moves[0] + moves[1] + moves[2], 2 * step);
    EXPECT_EQ(std::max({moves[0], moves[1], moves[2]}), step);
  }
}

TEST(Grid, WalksItsSidesFromCornerToCornerAndListsTheInsideByLevel) {
  const Grid grid = make_grid(3);
  for (int c = 0; c < 3; ++c)
    EXPECT_EQ(grid.on_side(c, 8), grid.on_side((c + 1) % 3, 0));
  EXPECT_EQ(grid.vertices[grid.on_side(0, 0)].i, 8);
  EXPECT_EQ(grid.vertices[grid.on_side(0, 3)].j, 3);
  EXPECT_EQ(grid.vertices[grid.on_side(1, 3)].k, 3);
  EXPECT_EQ(grid.vertices[grid.on_side(2, 3)].i, 3);
  EXPECT_EQ(grid.interior.size(), 21u);
  int level = 0;
  for (const std::uint32_t v : grid.interior) {
    EXPECT_GE(grid.vertices[v].level, level);
    level = grid.vertices[v].level;
    EXPECT_TRUE(grid.vertices[v].i > 0 && grid.vertices[v].j > 0 && grid.vertices[v].k > 0);
  }
}

}  // namespace
}  // namespace limn
