#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace limn {

/// How a refined face is triangulated (docs/patterns.md).
enum class PatternFamily {
  /// The uniform grid P_m inside, its border triangles fanned to the finer sides' points: what blends without a jump
  /// (docs/watertight.md). The default.
  kNested,
  /// As few triangles as each side's own number of segments allows (Lenz et al. 2009, section 4), well shaped.
  kMinimal,
};

/// The deepest level that patterns are made for: 2^8 segments a side.
inline constexpr int kMaxPatternLevel = 8;

/// What one face asks for.
struct PatternConfig {
  std::uint8_t inner = 0;               ///< m, the level of the grid inside; kNested only, kMinimal ignores it
  std::array<std::uint8_t, 3> sides{};  ///< log2 of the segments of side c, from corner c to corner (c + 1) % 3

  bool operator==(const PatternConfig&) const = default;
};

/// Which stored pattern serves a configuration, and how its corners lie on the face's.
struct PatternChoice {
  std::uint32_t base = 0;        ///< the pattern of the sorted configuration
  std::uint8_t permutation = 0;  ///< 0 … 5: corner b of the pattern is corner kCornerOf[permutation][b] of the face
  bool mirrored = false;         ///< the permutation is odd: triangles must be wound the other way

  bool operator==(const PatternChoice&) const = default;
};

/// The face's corner that is the pattern's corner b. A point with weights (u, v, w) in the pattern has on the face the
/// weight u at corner kCornerOf[p][0], v at kCornerOf[p][1], w at kCornerOf[p][2].
inline constexpr std::uint8_t kCornerOf[6][3] = {{0, 1, 2}, {2, 1, 0}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}};

/// The inverse, as Table 2 of Lenz et al. 2009 lists it: the face's corner c takes weight kWeightOf[p][c] of the
/// pattern's (u, v, w).
inline constexpr std::uint8_t kWeightOf[6][3] = {{0, 1, 2}, {2, 1, 0}, {0, 2, 1}, {1, 0, 2}, {2, 0, 1}, {1, 2, 0}};

/// From λ as published to one of the six permutations: 2 and 7 are the same one, 3 cannot occur.
inline constexpr std::uint8_t kPermutationOfLambda[8] = {0, 1, 2, 0, 3, 4, 5, 2};

/// λ of Lenz et al. 2009, Fig. 8: which swaps sort the three sides in descending order, 1 + 2 + 4. Never 3.
std::uint8_t sorting_lambda(const std::array<std::uint8_t, 3>& sides);

/// The pattern that serves a face. Constant time; the same for every caller and device.
///
/// base, with i ≥ j ≥ k the sorted sides: kMinimal C(i+2,3) + C(j+1,2) + k; kNested, m the level inside,
/// C(i+3,4) + C(i−m+2,3) + C(j−m+1,2) + k−m. Neither depends on the deepest level that is stored; 0 is the unrefined
/// triangle. \pre no level exceeds kMaxPatternLevel; kNested: no side is below inner
PatternChoice choose_pattern(PatternFamily family, const PatternConfig& config);

/// Patterns with no level above max_level: C(M+3,3) of kMinimal (20 for 3, 84 for 6), C(M+4,4) of kNested (35, 210).
std::uint32_t pattern_count(PatternFamily family, int max_level);

/// The sorted configuration of a base: the inverse of choose_pattern. inner of kMinimal is 0.
PatternConfig pattern_config(PatternFamily family, std::uint32_t base);

/// A point of the parameter triangle with weights (2^level − j − k, j, k) / 2^level at corners 0, 1, 2.
struct PatternVertex {
  std::uint16_t j = 0, k = 0;
  std::uint8_t level = 0;  ///< that of the pattern's finest side

  constexpr std::uint16_t i() const { return static_cast<std::uint16_t>((1u << level) - j - k); }
  bool operator==(const PatternVertex&) const = default;
};

/// Where a pattern's vertex lies on a face that uses it with this permutation: the weights at the face's corners.
constexpr PatternVertex on_face(const PatternVertex& v, std::uint8_t permutation) {
  const std::uint16_t weights[3] = {v.i(), v.j, v.k};
  return {weights[kWeightOf[permutation][1]], weights[kWeightOf[permutation][2]], v.level};
}

/// The four bytes in which a device stores a vertex: j in bits 0–9, k in bits 10–19, level in bits 20–23.
constexpr std::uint32_t pack(const PatternVertex& v) {
  return static_cast<std::uint32_t>(v.j) | static_cast<std::uint32_t>(v.k) << 10 |
         static_cast<std::uint32_t>(v.level) << 20;
}
constexpr PatternVertex unpack(std::uint32_t word) {
  return {static_cast<std::uint16_t>(word & 1023u), static_cast<std::uint16_t>(word >> 10 & 1023u),
          static_cast<std::uint8_t>(word >> 20)};
}

using PatternTriangle = std::array<std::uint16_t, 3>;

/// A stored triangulation of the parameter triangle.
struct Pattern {
  PatternConfig config;  ///< sorted: sides descending
  /// Corners 0, 1, 2; the inner points of side 0 from corner 0 on, of side 1, of side 2; then those inside by the
  /// refinement in which the uniform grid first has them, k, j.
  std::vector<PatternVertex> vertices;
  std::vector<PatternTriangle> triangles;  ///< wound as (corner 0, corner 1, corner 2)

  /// Vertices that are on the border: corners and inner points of sides.
  std::size_t border() const {
    return (std::size_t{1} << config.sides[0]) + (std::size_t{1} << config.sides[1]) +
           (std::size_t{1} << config.sides[2]);
  }
  /// The vertex q segments along side c, from corner c. \pre 0 <= q <= 2^sides[c]
  std::uint16_t on_side(int c, int q) const;
};

/// The pattern of a sorted configuration. The same bits on every machine: integers only, and IEEE divisions.
///
/// Every triangle has positive area in exact arithmetic and none has three points of one side; sides have just the
/// points of their 2^t segments. Cost: proportional to the result, but kMinimal with a side of one segment,
/// 2^i + 2^j + 1 points (docs/patterns.md). \pre sides descend, no level exceeds kMaxPatternLevel; kNested: inner is
/// at most sides[2]
Pattern make_pattern(PatternFamily family, const PatternConfig& config);

}  // namespace limn
