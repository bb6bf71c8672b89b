#pragma once

#include <vector>

#include "limn/base/vec.h"

namespace limn {

/// Which functions a refined triangle's points are summed from, and how they are stored.
enum class DykenBasis {
  kNine,        ///< equation (12), with the center of equation (5): eight stored, two texels a look-up
  kNinePacked,  ///< the same, two to a channel, of 12 bits: one texel a look-up
  kTen,         ///< the Bernstein polynomials, with the center of equation (4): three texels a look-up
};

/// A texture of basis functions sampled at every level and linear in between, S_l[B](p) of equation (14), for every
/// vertex p of P_M: a block of M + 1 texels by 1, 2 or 3 for each vertex (j, k), the block of column j and row k; level
/// l in column l, so that the two levels that are blended lie side by side. Dyken et al. 2008, section 6.4.
///
/// Texels hold functions in the order b300 b030 b003 b210 b120 b021 b012 b102 b201 b111. kNine: 1 to 4, then 5 to 8;
/// function 0 is what is missing from 1. kNinePacked: functions n and n + 4 in a channel, q_n + q_{n+4} / 4096, in
/// units of 1 / kPackedWhole. kTen: the same rows as kNine, then functions 0 and 9.
struct BasisTable {
  int level = 0;  ///< M
  int rows = 0;   ///< texels of a level in a block
  int width = 0, height = 0;
  std::vector<Vec4> texels;  ///< row by row; 0 where a block has no vertex
};

/// What stands for 1 in packed functions: even, so that an edge's four functions can sum to it at the edge's middle
/// too, and below 2^12.
inline constexpr int kPackedWhole = 4094;

/// Values that are not packed are exact: multiples of 2^-24 at most, since 3M <= 24. Packed ones are the nearest, but
/// on edges they sum to 1 and do not depend on the direction the edge runs in.
/// Memory: 16 bytes a texel, so (2^M + 1)² (M + 1) 16 bytes a row. \pre 0 <= max_level <= kMaxLevel
BasisTable make_basis_table(DykenBasis basis, int max_level);

}  // namespace limn
