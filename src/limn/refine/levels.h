#pragma once

#include <span>
#include <vector>

#include "limn/base/result.h"
#include "limn/mesh/topology.h"
#include "limn/refine/edge_curve.h"
#include "limn/silhouette/eye.h"
#include "limn/silhouette/silhouetteness.h"

namespace limn {

/// Where a mesh is refined.
enum class Criterion {
  kSilhouette,  ///< near the outline: s = M·α (Dyken et al. 2008, sections 3 and 5)
  kDistance,    ///< near the eye: M at near_distance and closer, 0 at far_distance and beyond, linear in the logarithm
                ///< between
  kCurvature,   ///< where the surface bends: √|K| times the edge's length, K Meyer's discrete Gaussian curvature
                ///< averaged from its ends, is the angle the surface turns along it; M from kFullTurn_rad on
  kUniform,     ///< M everywhere
  kTags,        ///< Mesh::tags at the vertices, averaged to edges (Lenz et al. 2009, section 3), clamped to [0, M]
};

/// The deepest level anything here takes: 2^8 segments an edge.
inline constexpr int kMaxLevel = 8;

/// Levels are multiples of this, so that whoever computes them can agree exactly (docs/levels.md).
inline constexpr float kLevelUnit = 1.0f / 4096;

/// The nearest multiple of kLevelUnit, the larger of two that are as near: floor(4096 s + ½) / 4096.
/// \pre level >= 0
float quantized_level(double level);

/// The turn along an edge from which Criterion::kCurvature refines fully: 45°.
inline constexpr float kFullTurn_rad = 0.78539816f;

struct LevelOptions {
  Criterion criterion = Criterion::kSilhouette;
  int max_level = 3;  ///< M, 0 … kMaxLevel
  Wedge wedge{};      ///< kSilhouette
  /// τ, the largest distance in pixels between an edge's curve and its segments; 0: levels are M times the criterion.
  /// With it s = α·clamp(½·log2(e/τ), 0, M), e a bound of the projected distance of the curve from its chord
  /// (halving a cubic's step quarters it; docs/levels.md), α the criterion's value in [0, 1]. Needs
  /// View::pixels_per_unit.
  float pixels = 0.0f;
  float near_distance =
      0.0f;  ///< kDistance; both 0: half and twice the distance from the eye to the middle of the mesh
  float far_distance = 0.0f;
};

/// The geometric refinement level of every edge, once an edge and never a triangle, so that neighbours agree.
///
/// Multiples of kLevelUnit in [0, max_level]. \param face_normals  face_normals() of the mesh
/// Cost: one pass over the edges (kCurvature: and one over the faces). Same bits for any number of threads.
/// Errors: kInvalidArgument for options out of range, kDistance without a perspective eye, or pixels without a scale;
/// kUnsuitable for kTags without tags.
Result<std::vector<float>> edge_levels(const Mesh& mesh, const Topology& topology, std::span<const Vec3> face_normals,
                                       std::span<const EdgeCurve> curves, const View& view,
                                       const LevelOptions& options);

/// Whether edge_levels() can do what the options ask of this mesh and view; its errors.
Result<void> check_levels(const Mesh& mesh, const View& view, const LevelOptions& options);

/// The criterion's value α at every edge, in [0, 1]: what edge_levels() makes levels of.
/// \param face_normals  kSilhouette needs them. Errors and cost as edge_levels().
Result<std::vector<float>> edge_shares(const Mesh& mesh, const Topology& topology, std::span<const Vec3> face_normals,
                                       const View& view, const LevelOptions& options);

/// Meyer's discrete Gaussian curvature at every welded vertex (Meyer et al. 2002, section 4): the angle missing from 2π
/// (from π at a boundary) over the mixed Voronoi area; 0 at vertices without faces and where the area is 0.
/// Indexed by position; positions welded to another have 0. Same bits for any number of threads.
std::vector<float> gaussian_curvature(const Mesh& mesh, const Topology& topology);

}  // namespace limn
