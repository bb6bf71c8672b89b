#pragma once

#include <span>
#include <vector>

#include "limn/base/progress.h"
#include "limn/base/result.h"
#include "limn/mesh/mesh.h"
#include "limn/mesh/topology.h"
#include "limn/refine/blend.h"
#include "limn/refine/patch.h"
#include "limn/refine/patterns/pattern.h"

namespace limn {

struct TessellateOptions {
  Blend blend = Blend::kSurplus;
  CenterRule center = CenterRule::kPn;
  PatternFamily family = PatternFamily::kNested;
  std::size_t max_triangles = 100'000'000;
  Progress progress;
};

/// A refined mesh and where it came from.
struct Refinement {
  /// Positions first those of the input that faces use (welded, in order), then edge by edge, then face by face. Every
  /// corner attribute is indexed (CornerAttribute::indices). Materials are the input's.
  Mesh mesh;
  std::vector<float> edge_levels;        ///< one an input edge: s
  std::vector<FaceId> source_face;       ///< one an output face
  std::vector<std::uint8_t> face_level;  ///< one an input face: its topological level m, the largest s rounded up
  std::size_t refined_faces = 0;         ///< input faces with m > 0
};

/// Tessellates every face by the pattern that choose_pattern() names, its triangles in the pattern's order, wound as
/// the face is.
///
/// Let m be a face's topological level, the largest of its edges' levels rounded up (Dyken et al. 2008, section 5).
/// kNested: the grid P_m; each edge gets 2^t segments, t the larger m of its faces, and the coarser side fans its
/// border triangles to them, so that no surface point moves. kMinimal: each edge gets 2^⌈s⌉ segments, and the pattern's
/// points inside lie on the same surface; as the pattern changes where a level crosses an integer, it jumps there,
/// except along edges (docs/patterns.md). Either way an edge's points are computed once, at its own level s, and stored
/// once: there is no T-junction. Degenerate faces are left out: a closed input stays closed. Same bits for any number
/// of threads. Errors: kUnsuitable when more than max_triangles triangles or 2^32−2 vertices would result; kCancelled.
/// \pre mesh.normals is not empty; one curve and one level an edge; levels in [0, kMaxLevel]
Result<Refinement> tessellate(const Mesh& mesh, const Topology& topology, std::span<const EdgeCurve> curves,
                              std::span<const float> levels, const TessellateOptions& options = {});

}  // namespace limn
