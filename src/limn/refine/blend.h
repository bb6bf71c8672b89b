#pragma once

#include <span>

#include "limn/base/vec.h"
#include "limn/refine/edge_curve.h"
#include "limn/refine/grid.h"
#include "limn/refine/patch.h"

namespace limn {

/// How geometry is blended between integer levels.
enum class Blend {
  /// Hierarchical surplus: each dyadic vertex of level l moves from its parents' midpoint by clamp(s − (l−1), 0, 1) of
  /// its
  /// detail. Continuous in every level (docs/blending.md). The default.
  kSurplus,
  /// Equations (9)–(11) of Dyken et al. 2008 as published: the interior jumps where the largest of a face's levels
  /// crosses an integer.
  kPaper,
};

/// Samples an edge at 2^t segments: where its curve runs, and where the surface of geometric level s does.
///
/// \param curve_points    2^t + 1 points F of the cubic, from p0 to p1
/// \param surface_points  as many points of the edge at level s; F itself, bit for bit, where s reaches the vertex's
/// level \pre p0 and p1 are the positions of the edge's v[0] and v[1] in this order; s <= t <= kMaxLevel
void sample_edge(const Vec3& p0, const EdgeCurve& curve, const Vec3& p1, float s, int t, Blend blend,
                 std::span<Vec3> curve_points, std::span<Vec3> surface_points);

/// Samples a patch inside at the grid's vertices, s the largest of its edges' levels.
///
/// \param patch_points    one a grid vertex; the border, from sample_edge's curve points, is read, the interior written
/// \param surface_points  likewise
/// \pre grid.level is s rounded up, or more
void sample_interior(const Grid& grid, const Patch& patch, float s, Blend blend, std::span<Vec3> patch_points,
                     std::span<Vec3> surface_points);

}  // namespace limn
