#include "limn/refine/blend.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace limn {
namespace {

/// The share of its detail that a vertex of this level has at geometric level s.
float surplus_share(float s, int level) {
  return std::clamp(s - static_cast<float>(level - 1), 0.0f, 1.0f);
}

/// The vertex between parents a and b that sits at f on the patch; *_f their points on the patch, *_p on the surface.
/// Written as a displacement from f, so that with all shares 1 the result is f, bit for bit.
Vec3 surplus_point(const Vec3& f, const Vec3& a_f, const Vec3& b_f, const Vec3& a_p, const Vec3& b_p, float share) {
  if (share == 0.0f) return (a_p + b_p) * 0.5f;
  const Vec3 inherited = ((a_p - a_f) + (b_p - b_f)) * 0.5f;
  const Vec3 detail = f - (a_f + b_f) * 0.5f;
  return f + (inherited - detail * (1.0f - share));
}

/// S_l[F] at segment k of 2^t along an edge: linear between the vertices of level l.
Vec3 sampled_on_edge(std::span<const Vec3> f, std::size_t k, int t, int l) {
  const std::size_t step = std::size_t{1} << (t - l);
  const std::size_t low = k & ~(step - 1);
  if (low == k) return f[k];
  const float x = static_cast<float>(k - low) / static_cast<float>(step);
  return f[low] * (1.0f - x) + f[low + step] * x;
}

/// S_l[F] at a vertex of the grid: linear on the triangle of level l that holds it (equation (7)).
Vec3 sampled_on_grid(const Grid& grid, std::span<const Vec3> f, const GridVertex& vertex, int l) {
  const int step = 1 << (grid.level - l);
  const int j = vertex.j & ~(step - 1);
  const int k = vertex.k & ~(step - 1);
  const int dj = vertex.j - j;
  const int dk = vertex.k - k;
  if (dj == 0 && dk == 0) return f[grid.index(j, k)];
  const float unit = 1.0f / static_cast<float>(step);
  if (dj + dk <= step) {
    // On the diagonal this triangle's third weight is 0, and the neighbour's corner may lie outside the grid.
    const Vec3 sides = f[grid.index(j + step, k)] * (static_cast<float>(dj) * unit) +
                       f[grid.index(j, k + step)] * (static_cast<float>(dk) * unit);
    return f[grid.index(j, k)] * (static_cast<float>(step - dj - dk) * unit) + sides;
  }
  const Vec3 sides = f[grid.index(j, k + step)] * (static_cast<float>(step - dj) * unit) +
                     f[grid.index(j + step, k)] * (static_cast<float>(step - dk) * unit);
  return f[grid.index(j + step, k + step)] * (static_cast<float>(dj + dk - step) * unit) + sides;
}

/// Equation (9): between the samplings at the integers around s.
template <class Sampled>
Vec3 paper_point(float s, const Sampled& sampled_at) {
  const int low = static_cast<int>(std::floor(s));
  const float alpha = s - static_cast<float>(low);
  if (alpha == 0.0f) return sampled_at(low);
  return sampled_at(low) * (1.0f - alpha) + sampled_at(low + 1) * alpha;
}

}  // namespace

void sample_edge(const Vec3& p0, const EdgeCurve& curve, const Vec3& p1, float s, int t, Blend blend,
                 std::span<Vec3> curve_points, std::span<Vec3> surface_points) {
  const std::size_t n = std::size_t{1} << t;
  assert(s <= static_cast<float>(t) && curve_points.size() == n + 1 && surface_points.size() == n + 1);
  for (std::size_t k = 0; k <= n; ++k)
    curve_points[k] = evaluate_curve(p0, curve, p1, static_cast<int>(k), t);
  curve_points.front() = surface_points.front() = p0;
  curve_points.back() = surface_points.back() = p1;
  for (int level = 1; level <= t; ++level) {
    const std::size_t step = n >> level;
    for (std::size_t k = step; k < n; k += 2 * step) {
      surface_points[k] =
          blend == Blend::kPaper
              ? paper_point(s, [&](int l) { return sampled_on_edge(curve_points, k, t, l); })
              : surplus_point(curve_points[k], curve_points[k - step], curve_points[k + step], surface_points[k - step],
                              surface_points[k + step], surplus_share(s, level));
    }
  }
}

void sample_interior(const Grid& grid, const Patch& patch, float s, Blend blend, std::span<Vec3> patch_points,
                     std::span<Vec3> surface_points) {
  assert(s <= static_cast<float>(grid.level) && patch_points.size() == grid.vertices.size());
  const float unit = 1.0f / static_cast<float>(grid.segments());
  for (const std::uint32_t v : grid.interior) {
    const GridVertex& g = grid.vertices[v];
    patch_points[v] = evaluate_patch(patch, static_cast<float>(g.i) * unit, static_cast<float>(g.j) * unit,
                                     static_cast<float>(g.k) * unit);
  }
  for (const std::uint32_t v : grid.interior) {
    const GridVertex& g = grid.vertices[v];
    const std::uint32_t a = g.parents[0];
    const std::uint32_t b = g.parents[1];
    surface_points[v] = blend == Blend::kPaper
                            ? paper_point(s, [&](int l) { return sampled_on_grid(grid, patch_points, g, l); })
                            : surplus_point(patch_points[v], patch_points[a], patch_points[b], surface_points[a],
                                            surface_points[b], surplus_share(s, g.level));
  }
}

}  // namespace limn
