#include "limn/refine/patterns/minimal.h"

#include <algorithm>
#include <bit>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "limn/refine/patterns/border.h"
#include "limn/refine/patterns/delaunay.h"

namespace limn {
namespace {

/// Up to this level every pattern is laid out by itself.
constexpr std::uint8_t kSmallLevel = 3;
/// Points are moved about in patterns that have this many at most.
constexpr std::size_t kMostPolished = 16;
/// Points are tried on the grid of this level or the pattern's own, whichever is coarser.
constexpr int kTrialLevel = 4;
/// Cotangent of 35°: what a triangle's smallest angle falls short of it, in cotangents, is its cost, squared.
constexpr double kWantedCotangent = 1.4281480;
/// What a point must at least take off that sum to be worth its two triangles.
constexpr double kPointCost = 0.2;

/// The refinement in which the uniform grid first has the vertex.
int grid_level(const PatternVertex& v) {
  const unsigned all = static_cast<unsigned>(v.i()) | v.j | v.k;
  return v.level - std::countr_zero(all);
}

bool inside_order(const PatternVertex& a, const PatternVertex& b) {
  return std::tuple(grid_level(a), a.k, a.j) < std::tuple(grid_level(b), b.k, b.j);
}

/// Gives the vertices inside their order.
Pattern in_order(const std::array<std::uint8_t, 3>& sides, const std::vector<PatternVertex>& vertices,
                 std::vector<PatternTriangle> triangles) {
  Pattern pattern = pattern_border({0, sides});
  const std::size_t border = pattern.vertices.size();
  std::vector<PatternVertex> all = pattern.vertices;
  for (const PatternVertex& v : vertices) {
    if (v.j > 0 && v.k > 0 && v.i() > 0) all.push_back(v);
  }
  std::sort(all.begin() + static_cast<std::ptrdiff_t>(border), all.end(), inside_order);
  std::map<std::pair<int, int>, std::uint16_t> places;
  for (std::size_t n = 0; n < all.size(); ++n)
    places[{all[n].j, all[n].k}] = static_cast<std::uint16_t>(n);
  for (PatternTriangle& t : triangles) {
    for (std::uint16_t& v : t)
      v = places.at({vertices[v].j, vertices[v].k});
  }
  pattern.vertices = std::move(all);
  pattern.triangles = std::move(triangles);
  return pattern;
}

PatternVertex between(const PatternVertex& a, const PatternVertex& b) {
  return {static_cast<std::uint16_t>(a.j + b.j), static_cast<std::uint16_t>(a.k + b.k),
          static_cast<std::uint8_t>(a.level + 1)};
}

/// Every triangle cut in four at the middles of its edges.
Pattern cut_in_four(const Pattern& coarse) {
  std::vector<PatternVertex> vertices;
  for (const PatternVertex& v : coarse.vertices)
    vertices.push_back(between(v, v));
  std::map<std::pair<std::uint16_t, std::uint16_t>, std::uint16_t> middles;
  const auto middle = [&](std::uint16_t a, std::uint16_t b) {
    const auto [place, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<std::uint16_t>(vertices.size()));
    if (is_new) vertices.push_back(between(coarse.vertices[a], coarse.vertices[b]));
    return place->second;
  };
  std::vector<PatternTriangle> triangles;
  for (const auto& [a, b, c] : coarse.triangles) {
    const std::uint16_t ab = middle(a, b);
    const std::uint16_t bc = middle(b, c);
    const std::uint16_t ca = middle(c, a);
    triangles.push_back({a, ab, ca});
    triangles.push_back({ab, b, bc});
    triangles.push_back({ca, bc, c});
    triangles.push_back({bc, ca, ab});
  }
  std::array<std::uint8_t, 3> sides = coarse.config.sides;
  for (std::uint8_t& side : sides)
    ++side;
  return in_order(sides, vertices, std::move(triangles));
}

/// Where the pattern's own symmetry takes a point: the point itself where it has none or the point lies on its axis.
PatternVertex mirrored(const std::array<std::uint8_t, 3>& sides, const PatternVertex& v) {
  if (sides[0] == sides[1])
    return {v.j, v.i(), v.level};  // about corner 1: the weights of corners 0 and 2 change places
  if (sides[1] == sides[2]) return {v.i(), v.k, v.level};  // about corner 2
  return v;
}

/// A choice of points inside, and what it costs.
struct Layout {
  PatternDelaunay mesh;
  std::vector<PatternVertex> inside;
  double cost = 0;
};

class Planner {
 public:
  explicit Planner(const std::array<std::uint8_t, 3>& sides)
      : sides_(sides), fitted_(fit_triangle(sides)), border_(pattern_border({0, sides})) {}

  Layout start(const std::vector<PatternVertex>& inside) const {
    Layout layout{PatternDelaunay(border_), {}, 0};
    for (const PatternVertex& v : inside)
      add(layout, v);
    layout.cost = cost(layout);
    return layout;
  }
  void improve(Layout& layout, std::size_t most) const;
  void polish(Layout& layout) const;

 private:
  Layout best_around(const Layout& layout, const PatternVertex& from) const;
  void add(Layout& layout, const PatternVertex& v) const {
    layout.mesh.insert(v);
    layout.inside.push_back(v);
  }
  /// Adds a point and its mirror image.
  void add_both(Layout& layout, const PatternVertex& v) const {
    add(layout, v);
    if (const PatternVertex other = mirrored(sides_, v); other != v) add(layout, other);
  }
  static bool has(const Layout& layout, const PatternVertex& v) {
    return std::find(layout.inside.begin(), layout.inside.end(), v) != layout.inside.end();
  }
  double cost(const Layout& layout) const {
    double sum = kPointCost * static_cast<double>(layout.inside.size());
    layout.mesh.for_each([&](const PatternVertex& a, const PatternVertex& b, const PatternVertex& c) {
      const double excess = std::max(0.0, fitted_.sharpest_cotangent(a, b, c) - kWantedCotangent);
      sum += excess * excess;
    });
    return sum;
  }

  std::array<std::uint8_t, 3> sides_;
  FittedTriangle fitted_;
  Pattern border_;
};

/// Adds the point that helps most, again and again, while one is worth its cost.
void Planner::improve(Layout& layout, std::size_t most) const {
  const int n = 1 << sides_[0];
  const int step = std::max(1, n >> kTrialLevel);
  while (layout.inside.size() < most) {
    std::optional<Layout> best;
    for (int k = step; k < n; k += step) {
      for (int j = step; j + k < n; j += step) {
        const PatternVertex v{static_cast<std::uint16_t>(j), static_cast<std::uint16_t>(k), sides_[0]};
        if (has(layout, v)) continue;
        Layout trial = layout;
        add_both(trial, v);
        trial.cost = cost(trial);
        if (trial.cost < (best ? best->cost : layout.cost)) best = std::move(trial);
      }
    }
    if (!best) return;
    layout = std::move(*best);
  }
}

/// The best layout with this point, and its mirror image, at one of the places around it or nowhere.
Layout Planner::best_around(const Layout& layout, const PatternVertex& from) const {
  constexpr int kReach = 2;
  const int n = 1 << sides_[0];
  std::vector<PatternVertex> others;
  for (const PatternVertex& v : layout.inside) {
    if (v != from && v != mirrored(sides_, from)) others.push_back(v);
  }
  const Layout without = start(others);
  Layout best = without;
  for (int k = std::max(1, from.k - kReach); k <= from.k + kReach; ++k) {
    for (int j = std::max(1, from.j - kReach); j <= from.j + kReach && j + k < n; ++j) {
      const PatternVertex to{static_cast<std::uint16_t>(j), static_cast<std::uint16_t>(k), from.level};
      if (has(without, to)) continue;
      Layout trial = without;
      add_both(trial, to);
      trial.cost = cost(trial);
      if (trial.cost < best.cost) best = std::move(trial);
    }
  }
  return best;
}

/// Moves points, one by one, to others nearby on the grid, or takes them away, while that helps.
void Planner::polish(Layout& layout) const {
  for (bool moved = true; moved;) {
    moved = false;
    for (std::size_t at = 0; at < layout.inside.size() && !moved; ++at) {
      Layout best = best_around(layout, layout.inside[at]);
      moved = best.cost < layout.cost;
      if (moved) layout = std::move(best);
    }
  }
}

/// The points inside the pattern whose finest side is half as fine, on this pattern's grid.
std::vector<PatternVertex> inherited(std::array<std::uint8_t, 3> sides) {
  --sides[0];
  const Pattern coarse = make_minimal_pattern(sides);
  std::vector<PatternVertex> points;
  for (std::size_t n = coarse.border(); n < coarse.vertices.size(); ++n)
    points.push_back(between(coarse.vertices[n], coarse.vertices[n]));
  return points;
}

}  // namespace

Pattern make_minimal_pattern(const std::array<std::uint8_t, 3>& sides) {
  const auto [i, j, k] = sides;
  const bool uniform = i == k;
  if (k > 0 && (uniform || (i > kSmallLevel && i <= j + 1))) {
    return cut_in_four(make_minimal_pattern(
        {static_cast<std::uint8_t>(i - 1), static_cast<std::uint8_t>(j - 1), static_cast<std::uint8_t>(k - 1)}));
  }
  const Planner planner(sides);
  const std::size_t border = pattern_border({0, sides}).vertices.size();
  Layout layout = planner.start(i > kSmallLevel && i >= j + 2 ? inherited(sides) : std::vector<PatternVertex>());
  planner.improve(layout, layout.inside.size() + border / 4);
  if (layout.inside.size() <= kMostPolished) planner.polish(layout);
  return in_order(sides, layout.mesh.vertices(), layout.mesh.triangles());
}

}  // namespace limn
