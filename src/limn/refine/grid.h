#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace limn {

/// A vertex (i, j, k) / 2^m of the uniformly refined triangle: i belongs to corner 0, j to corner 1, k to corner 2.
struct GridVertex {
  std::uint16_t i, j, k;
  std::uint8_t level;  ///< the refinement at which it first appears: 0 for corners
  /// The ends of the edge of the previous refinement that it halves; a corner is its own parents.
  std::uint32_t parents[2];
};

/// The m-th uniform refinement P_m of the parameter triangle (Dyken et al. 2008, section 5, equation (6)).
///
/// Vertices lie in rows k = 0 … n, n = 2^m, each from j = 0 to n − k; triangles are wound as (corner 0, corner 1,
/// corner 2).
struct Grid {
  int level = 0;
  std::vector<GridVertex> vertices;  ///< (n + 1)(n + 2) / 2
  std::vector<std::array<std::uint32_t, 3>>
      triangles;                        ///< 4^m; those that point the way P_0 does start in row k, column j
  std::vector<std::uint32_t> interior;  ///< vertices inside, by ascending level, then index

  int segments() const { return 1 << level; }
  std::uint32_t index(int j, int k) const {
    return static_cast<std::uint32_t>(k * (segments() + 1) - k * (k - 1) / 2 + j);
  }
  /// The vertex q segments along side c, from corner c towards corner (c + 1) % 3. \pre 0 <= q <= 2^m
  std::uint32_t on_side(int c, int q) const {
    const int n = segments();
    if (c == 0) return index(q, 0);
    return c == 1 ? index(n - q, q) : index(0, n - q);
  }
};

/// \pre 0 <= level <= 8
Grid make_grid(int level);

}  // namespace limn
