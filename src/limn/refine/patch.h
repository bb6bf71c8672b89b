#pragma once

#include <array>
#include <span>

#include "limn/base/vec.h"
#include "limn/refine/edge_curve.h"

namespace limn {

/// How a patch's middle control point is found.
enum class CenterRule {
  kPn,    ///< equation (4) of Dyken et al. 2008, as PN triangles (Vlachos et al. 2001)
  kMean,  ///< equation (5), the mean of the six inner edge points: a little flatter, and nine basis functions suffice
};

/// A cubic triangular Bézier patch. Corner 0 has u = 1, corner 1 v = 1, corner 2 w = 1.
struct Patch {
  Vec3 b300, b030, b003;
  Vec3 b210, b120;  ///< along edge 0, from corner 0 to corner 1
  Vec3 b021, b012;  ///< along edge 1, from corner 1 to corner 2
  Vec3 b102, b201;  ///< along edge 2, from corner 2 to corner 0
  Vec3 b111;
};

/// The patch of a face from its edges' curves. \pre the face is not degenerate
Patch make_patch(const Mesh& mesh, const Topology& topology, std::span<const EdgeCurve> curves, FaceId face,
                 CenterRule rule);

/// The point at barycentric coordinates u + v + w = 1, by plain sums in one fixed order.
///
/// For points inside a patch only: at an edge the two sides' sums round differently, and the surface would crack; there
/// use evaluate_curve (docs/watertight.md).
Vec3 evaluate_patch(const Patch& patch, float u, float v, float w);

/// The nine functions of equation (12), u³, 3u²v+uvw, …, that with CenterRule::kMean replace the ten Bernstein
/// polynomials. They sum to 1. Order: b300 b030 b003 b210 b120 b021 b012 b102 b201.
std::array<float, 9> nine_basis_functions(float u, float v, float w);

/// Control normals of the quadratic normal field (Vlachos et al. 2001, section 3.3).
struct NormalPatch {
  Vec3 n200, n020, n002;
  Vec3 n110, n011, n101;
};

/// From the corners' positions and unit normals.
NormalPatch make_normal_patch(const Vec3 (&p)[3], const Vec3 (&n)[3]);

/// The unit normal at u + v + w = 1.
Vec3 evaluate_normal(const NormalPatch& patch, float u, float v, float w);

}  // namespace limn
