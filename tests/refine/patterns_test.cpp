#include <algorithm>
#include <cmath>
#include <cstdio>
#include <gtest/gtest.h>
#include <map>
#include <numeric>
#include <set>
#include <string>

#include "limn/refine/grid.h"
#include "limn/refine/patterns/fitted.h"
#include "limn/refine/patterns/pattern.h"
#include "limn/refine/patterns/table.h"

namespace limn {
namespace {

constexpr PatternFamily kFamilies[] = {PatternFamily::kNested, PatternFamily::kMinimal};

std::string name_of(const PatternConfig& config) {
  const auto text = [](int level) { return std::to_string(level); };
  return text(config.inner) + "; " + text(config.sides[0]) + " " + text(config.sides[1]) + " " + text(config.sides[2]);
}

/// Every configuration, sorted or not, with levels up to max_level.
std::vector<PatternConfig> all_configs(PatternFamily family, int max_level) {
  std::vector<PatternConfig> configs;
  for (int m = 0; m <= (family == PatternFamily::kNested ? max_level : 0); ++m) {
    for (int a = m; a <= max_level; ++a) {
      for (int b = m; b <= max_level; ++b) {
        for (int c = m; c <= max_level; ++c) {
          configs.push_back(
              {static_cast<std::uint8_t>(m),
               {static_cast<std::uint8_t>(a), static_cast<std::uint8_t>(b), static_cast<std::uint8_t>(c)}});
        }
      }
    }
  }
  return configs;
}

TEST(ChoosePattern, NumbersTheSortedConfigurationsWithoutGapsWhateverTheDeepestLevel) {
  for (const PatternFamily family : kFamilies) {
    for (int max_level = 0; max_level <= kMaxPatternLevel; ++max_level) {
      std::set<std::uint32_t> bases;
      for (const PatternConfig& config : all_configs(family, max_level))
        bases.insert(choose_pattern(family, config).base);
      EXPECT_EQ(bases.size(), pattern_count(family, max_level));
      EXPECT_EQ(*bases.rbegin(), pattern_count(family, max_level) - 1);
    }
    EXPECT_EQ(choose_pattern(family, {}).base, 0u);
  }
  EXPECT_EQ(pattern_count(PatternFamily::kMinimal, 3), 20u);
  EXPECT_EQ(pattern_count(PatternFamily::kMinimal, 6), 84u);
  EXPECT_EQ(pattern_count(PatternFamily::kNested, 3), 35u);
  EXPECT_EQ(pattern_count(PatternFamily::kNested, 6), 210u);
}

TEST(ChoosePattern, AgreesWithItsFormulasAndItsInverse) {
  for (const PatternFamily family : kFamilies) {
    for (std::uint32_t base = 0; base < pattern_count(family, kMaxPatternLevel); ++base) {
      const PatternConfig config = pattern_config(family, base);
      EXPECT_TRUE(std::is_sorted(config.sides.rbegin(), config.sides.rend()));
      const PatternChoice expected{base, 0, false};
      EXPECT_EQ(choose_pattern(family, config), expected) << name_of(config);
    }
  }
  // By hand: C(5,3) + C(3,2) + 1, and C(6,4) + C(4,3) + C(2,2) + 0 for m = 1.
  EXPECT_EQ(choose_pattern(PatternFamily::kMinimal, {0, {3, 2, 1}}).base, 14u);
  EXPECT_EQ(choose_pattern(PatternFamily::kNested, {1, {3, 2, 1}}).base, 20u);
}

TEST(ChoosePattern, LaysThePatternsCornersSoThatEverySideHasItsSegments) {
  for (const PatternFamily family : kFamilies) {
    for (const PatternConfig& config : all_configs(family, 6)) {
      const PatternChoice choice = choose_pattern(family, config);
      const PatternConfig sorted = pattern_config(family, choice.base);
      if (family == PatternFamily::kNested) {
        EXPECT_EQ(sorted.inner, config.inner);
      }
      const std::uint8_t* const corner = kCornerOf[choice.permutation];
      for (std::size_t b = 0; b < 3; ++b) {
        const std::uint8_t from = corner[b];
        const std::uint8_t to = corner[(b + 1) % 3];
        // The face's side that starts at one of the two ends and leads to the other.
        const bool forward = to == (from + 1) % 3;
        EXPECT_NE(forward, choice.mirrored);
        EXPECT_EQ(sorted.sides[b], config.sides[forward ? from : to]) << name_of(config);
      }
    }
  }
}

TEST(SortingLambda, IsThatOfThePaperForEveryOrderOfThree) {
  // Table 1 and 2: from the order of the sides to λ and the permutation of (u, v, w).
  struct Row {
    std::array<std::uint8_t, 3> sides;
    std::uint8_t lambda;
    const char* permutation;
  };
  const Row rows[] = {{{2, 1, 0}, 0, "uvw"}, {{2, 0, 1}, 4, "vuw"}, {{1, 2, 0}, 1, "wvu"}, {{1, 0, 2}, 6, "vwu"},
                      {{0, 2, 1}, 5, "wuv"}, {{0, 1, 2}, 7, "uwv"}, {{0, 0, 1}, 2, "uwv"}};
  for (const Row& row : rows) {
    EXPECT_EQ(sorting_lambda(row.sides), row.lambda);
    const std::uint8_t permutation = kPermutationOfLambda[row.lambda];
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_EQ("uvw"[kWeightOf[permutation][c]], row.permutation[c]) << row.permutation;
  }
  for (const PatternConfig& config : all_configs(PatternFamily::kMinimal, 6))
    EXPECT_NE(sorting_lambda(config.sides), 3);
}

TEST(ChoosePattern, HasTablesThatAreEachOthersInverseAndSixDifferentPermutations) {
  std::set<std::vector<std::uint8_t>> permutations;
  for (std::uint8_t p = 0; p < 6; ++p) {
    permutations.insert({kCornerOf[p], kCornerOf[p] + 3});
    for (std::uint8_t b = 0; b < 3; ++b)
      EXPECT_EQ(kWeightOf[p][kCornerOf[p][b]], b);
    // A pattern's corner 1 lies at the face's corner kCornerOf[p][1].
    const PatternVertex at = on_face({4, 0, 2}, p);
    const std::uint16_t weights[3] = {at.i(), at.j, at.k};
    EXPECT_EQ(weights[kCornerOf[p][1]], 4);
  }
  EXPECT_EQ(permutations.size(), 6u);
}

/// The points of side c in order, corner to corner, from the pattern's own list.
std::vector<std::uint16_t> side_of(const Pattern& pattern, int c) {
  std::vector<std::uint16_t> side;
  for (int q = 0; q <= 1 << pattern.config.sides[static_cast<std::size_t>(c)]; ++q)
    side.push_back(pattern.on_side(c, q));
  return side;
}

void expect_ordered_vertices(const Pattern& pattern) {
  const int level = pattern.config.sides[0];
  const int n = 1 << level;
  for (int c = 0; c < 3; ++c) {
    const std::vector<std::uint16_t> side = side_of(pattern, c);
    const int step = n / (static_cast<int>(side.size()) - 1);
    for (std::size_t q = 0; q < side.size(); ++q) {
      const int at = static_cast<int>(q) * step;
      const int weights[3][3] = {{n - at, at, 0}, {0, n - at, at}, {at, 0, n - at}};
      const PatternVertex& v = pattern.vertices[side[q]];
      EXPECT_EQ(std::tuple(int{v.i()}, int{v.j}, int{v.k}), std::tuple(weights[c][0], weights[c][1], weights[c][2]));
    }
  }
  std::tuple<int, int, int> last;
  for (std::size_t i = 0; i < pattern.vertices.size(); ++i) {
    const PatternVertex& v = pattern.vertices[i];
    EXPECT_EQ(v.level, level);
    if (i < pattern.border()) continue;
    EXPECT_TRUE(v.i() > 0 && v.j > 0 && v.k > 0 && v.j + v.k < n);
    int step = 1;
    while (v.i() % (2 * step) == 0 && v.j % (2 * step) == 0 && v.k % (2 * step) == 0)
      step *= 2;
    const std::tuple now(-step, int{v.k}, int{v.j});
    if (i > pattern.border()) {
      EXPECT_LT(last, now);
    }
    last = now;
  }
}

void expect_conforming(const Pattern& pattern) {
  std::map<std::pair<int, int>, int> edges;
  std::int64_t area = 0;
  std::set<std::uint16_t> used;
  for (const PatternTriangle& t : pattern.triangles) {
    // Three points of one side span no area.
    const std::int64_t one =
        twice_area(pattern.vertices.at(t[0]), pattern.vertices.at(t[1]), pattern.vertices.at(t[2]));
    EXPECT_GT(one, 0);
    area += one;
    for (std::size_t c = 0; c < 3; ++c)
      ++edges[{t[c], t[(c + 1) % 3]}];
    used.insert(t.begin(), t.end());
  }
  EXPECT_EQ(area, std::int64_t{1} << (2 * pattern.config.sides[0]));
  EXPECT_EQ(used.size(), pattern.vertices.size());
  std::set<std::pair<int, int>> border;
  for (int c = 0; c < 3; ++c) {
    const std::vector<std::uint16_t> side = side_of(pattern, c);
    for (std::size_t q = 0; q + 1 < side.size(); ++q)
      border.insert({side[q], side[q + 1]});
  }
  std::size_t alone = 0;
  for (const auto& [ends, count] : edges) {
    EXPECT_EQ(count, 1);
    if (edges.contains({ends.second, ends.first})) continue;
    ++alone;
    EXPECT_TRUE(border.contains(ends));
  }
  EXPECT_EQ(alone, border.size());
  const std::size_t undirected = (edges.size() + alone) / 2;
  EXPECT_EQ(pattern.vertices.size() + pattern.triangles.size(), undirected + 1);
}

TEST(MakePattern, TriangulatesEveryConfigurationExactlyAndInOrder) {
  for (const PatternFamily family : kFamilies) {
    for (std::uint32_t base = 0; base < pattern_count(family, 6); ++base) {
      const PatternConfig config = pattern_config(family, base);
      SCOPED_TRACE(name_of(config));
      const Pattern pattern = make_pattern(family, config);
      EXPECT_EQ(pattern.config, config);
      expect_ordered_vertices(pattern);
      expect_conforming(pattern);
      if (testing::Test::HasFailure()) return;
    }
  }
}

TEST(MakePattern, WorksToTheDeepestLevel) {
  for (const std::array<std::uint8_t, 3>& sides :
       {std::array<std::uint8_t, 3>{8, 8, 8}, {8, 8, 7}, {8, 6, 6}, {8, 8, 0}, {8, 3, 0}, {7, 5, 2}, {8, 0, 0}}) {
    const Pattern minimal = make_pattern(PatternFamily::kMinimal, {0, sides});
    expect_ordered_vertices(minimal);
    expect_conforming(minimal);
    const Pattern nested = make_pattern(PatternFamily::kNested, {sides[2], sides});
    expect_ordered_vertices(nested);
    expect_conforming(nested);
  }
}

TEST(MakePattern, OfTheNestedFamilyIsTheGridWithItsBorderCut) {
  for (std::uint32_t base = 0; base < pattern_count(PatternFamily::kNested, 6); ++base) {
    const PatternConfig config = pattern_config(PatternFamily::kNested, base);
    const Pattern pattern = make_pattern(PatternFamily::kNested, config);
    const Grid grid = make_grid(config.inner);
    EXPECT_EQ(pattern.vertices.size() - pattern.border(), grid.interior.size());
    std::size_t expected = grid.triangles.size();
    for (const std::uint8_t t : config.sides)
      expected += (std::size_t{1} << t) - (std::size_t{1} << config.inner);
    EXPECT_EQ(pattern.triangles.size(), expected) << name_of(config);
  }
}

using Points = std::set<std::pair<int, int>>;

Points inside_of(const Pattern& pattern) {
  Points points;
  for (std::size_t n = pattern.border(); n < pattern.vertices.size(); ++n)
    points.insert({pattern.vertices[n].j, pattern.vertices[n].k});
  return points;
}

TEST(MakePattern, OfTheMinimalFamilyIsTheGridWhereSidesAreEqualAndAsSymmetricAsItsSides) {
  for (std::uint32_t base = 0; base < pattern_count(PatternFamily::kMinimal, 6); ++base) {
    const PatternConfig config = pattern_config(PatternFamily::kMinimal, base);
    const Pattern pattern = make_pattern(PatternFamily::kMinimal, config);
    const int n = 1 << config.sides[0];
    const Points points = inside_of(pattern);
    Points first, last;  // with corners 0 and 2, and 0 and 1, exchanged
    for (const auto& [j, k] : points) {
      first.insert({j, n - j - k});
      last.insert({n - j - k, k});
    }
    // Trapezia have no symmetric diagonal: where larger patterns cut one in four, its middle is off the axis.
    if (config.sides[0] == config.sides[1] && (config.sides[0] <= 3 || config.sides[2] == 0)) {
      EXPECT_EQ(points, first) << name_of(config);
    }
    if (config.sides[1] == config.sides[2]) {
      EXPECT_EQ(points, last) << name_of(config);
    }
    if (config.sides[0] == config.sides[2]) {
      EXPECT_EQ(pattern.triangles.size(), std::size_t{1} << (2 * config.sides[0]));
    }
  }
}

struct Quality {
  double triangles = 0, worst_deg = 90, mean_worst_deg = 0, small_share = 0;
};

Quality quality(int max_level) {
  Quality result;
  std::size_t small = 0;
  const std::uint32_t patterns = pattern_count(PatternFamily::kMinimal, max_level);
  for (std::uint32_t base = 0; base < patterns; ++base) {
    const Pattern pattern = make_pattern(PatternFamily::kMinimal, pattern_config(PatternFamily::kMinimal, base));
    double worst_deg = 90;
    for (const double angle_rad : smallest_angles_rad(pattern)) {
      const double angle_deg = angle_rad * 57.29577951308232;
      worst_deg = std::min(worst_deg, angle_deg);
      small += angle_deg < 10;
    }
    result.triangles += static_cast<double>(pattern.triangles.size());
    result.mean_worst_deg += worst_deg / patterns;
    result.worst_deg = std::min(result.worst_deg, worst_deg);
  }
  result.small_share = static_cast<double>(small) / result.triangles;
  result.triangles /= patterns;
  return result;
}

TEST(MakePattern, OfTheMinimalFamilyHasFewAndWellShapedTriangles) {
  for (const int max_level : {3, 6}) {
    const Quality q = quality(max_level);
    std::printf(
        "minimal patterns to level %d: %.2f triangles, worst angle %.1f degrees in the mean and %.1f at worst, "
        "%.1f %% of triangles under 10\n",
        max_level, q.triangles, q.mean_worst_deg, q.worst_deg, 100 * q.small_share);
    if (max_level != 3) continue;
    EXPECT_LE(q.triangles, 13.2);
    EXPECT_GE(q.mean_worst_deg, 27.0);
    EXPECT_GE(q.worst_deg, 7.0);
    EXPECT_LE(q.small_share, 0.015);
  }
}

TEST(FitTriangle, HasSidesAsLongAsTheirSegmentsOrAnAngleOf120Degrees) {
  const auto angle_deg = [](const FittedTriangle& t, std::size_t opposite) {
    const auto a = static_cast<double>(t.squared[(opposite + 1) % 3]);
    const auto b = static_cast<double>(t.squared[(opposite + 2) % 3]);
    return std::acos((a + b - static_cast<double>(t.squared[opposite])) / (2 * std::sqrt(a * b))) * 57.29577951308232;
  };
  EXPECT_EQ(fit_triangle({3, 3, 1}).squared, (std::array<std::int64_t, 3>{64, 64, 4}));
  EXPECT_NEAR(angle_deg(fit_triangle({2, 2, 2}), 0), 60, 1e-9);
  EXPECT_NEAR(angle_deg(fit_triangle({5, 2, 0}), 0), 120, 1e-9);
  // The smallest angle of an equilateral triangle, by the cotangents that patterns are laid out with.
  const Pattern one = make_pattern(PatternFamily::kMinimal, {});
  EXPECT_NEAR(smallest_angles_rad(one).at(0), 1.0471975511965976, 1e-12);
}

TEST(PatternTable, StoredAtBuildTimeIsTheOneMadeAnew) {
  for (const PatternFamily family : kFamilies) {
    EXPECT_EQ(pattern_table(family, kStoredPatternLevel), make_pattern_table(family, kStoredPatternLevel));
    for (const int max_level : {0, 3}) {
      EXPECT_EQ(pattern_table(family, max_level), make_pattern_table(family, max_level));
    }
  }
}

TEST(PatternTable, HoldsEveryPatternInBothWindings) {
  for (const PatternFamily family : kFamilies) {
    const PatternTable table = pattern_table(family, 4);
    ASSERT_EQ(table.ranges.size(), pattern_count(family, 4));
    for (std::uint32_t base = 0; base < table.ranges.size(); ++base) {
      const Pattern expected = make_pattern(family, pattern_config(family, base));
      for (const Pattern& found : {pattern_of(table, base), find_pattern(family, base)}) {
        EXPECT_EQ(found.config, expected.config);
        EXPECT_EQ(found.vertices, expected.vertices);
        EXPECT_EQ(found.triangles, expected.triangles);
      }
      const PatternRange& range = table.ranges[base];
      for (std::uint32_t t = 0; t < range.triangle_count; ++t) {
        const auto& [a, b, c] = table.triangles[range.first_triangle + t];
        EXPECT_EQ(table.mirrored[range.first_triangle + t], (PatternTriangle{a, c, b}));
      }
    }
  }
}

TEST(PatternTable, MirroredKeepsTheWindingOfTheFacesItIsLaidOn) {
  for (const PatternConfig& config : all_configs(PatternFamily::kMinimal, 3)) {
    const PatternChoice choice = choose_pattern(PatternFamily::kMinimal, config);
    const Pattern pattern = find_pattern(PatternFamily::kMinimal, choice.base);
    for (const auto& [a, b, c] : pattern.triangles) {
      const auto at = [&](std::uint16_t v) { return on_face(pattern.vertices[v], choice.permutation); };
      EXPECT_GT(choice.mirrored ? twice_area(at(a), at(c), at(b)) : twice_area(at(a), at(b), at(c)), 0);
    }
  }
}

TEST(PatternTable, FitsEightKilobytesAtLevelThree) {
  for (const PatternFamily family : kFamilies) {
    for (const int max_level : {3, 6}) {
      const PatternTable table = pattern_table(family, max_level);
      std::printf("%s to level %d: %zu patterns, %zu vertices, %zu triangles, %zu bytes on a device\n",
                  family == PatternFamily::kNested ? "nested" : "minimal", max_level, table.ranges.size(),
                  table.vertices.size(), table.triangles.size(), device_bytes(table));
    }
    EXPECT_LE(device_bytes(pattern_table(family, 3)), 8192u);
  }
}

TEST(PackedPatternVertex, IsUnpackedAsItWas) {
  for (int level = 0; level <= kMaxPatternLevel; ++level) {
    const int n = 1 << level;
    for (int k = 0; k <= n; ++k) {
      for (int j = 0; j + k <= n; ++j) {
        const PatternVertex v{static_cast<std::uint16_t>(j), static_cast<std::uint16_t>(k),
                              static_cast<std::uint8_t>(level)};
        EXPECT_EQ(unpack(pack(v)), v);
      }
    }
  }
}

}  // namespace
}  // namespace limn
