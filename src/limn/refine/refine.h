#pragma once

#include <span>
#include <vector>

#include "limn/base/progress.h"
#include "limn/base/result.h"
#include "limn/refine/levels.h"
#include "limn/refine/patch.h"
#include "limn/refine/tessellate.h"

namespace limn {

struct RefineOptions {
  LevelOptions levels{};
  Blend blend = Blend::kSurplus;
  CenterRule center = CenterRule::kPn;
  PatternFamily family = PatternFamily::kNested;
  /// Normals are computed, split at edges sharper than this, when the mesh brings none; NaN-free, in [0, π].
  float crease_angle_rad = 1.0471976f;
  bool recompute_normals = false;  ///< even when the mesh brings some
  std::size_t max_triangles = 100'000'000;
  Progress progress{};
};

/// Refines a mesh where its outline is, seen from `view`: normals, curves, levels, tessellation in one call.
///
/// The result is bitwise watertight where the input is closed: every vertex on a shared edge is one point, stored once;
/// no T-junctions; the input's winding. Normals vary quadratically, texture coordinates and colours linearly; tags are
/// used up. Same bits for any
/// number of threads. Errors: kUnsuitable (no faces, none with area, coordinates beyond 1e37, or more than
/// max_triangles would result), kInvalidArgument, kCancelled.
Result<Refinement> refine(const Mesh& mesh, const View& view, const RefineOptions& options = {});

/// Whether sums of the mesh's control points stay finite: no coordinate beyond 1e37. Errors: kUnsuitable.
Result<void> check_extent(const Mesh& mesh);

/// What refine() computes from the mesh alone, kept for many views of one mesh.
class Refiner {
 public:
  /// Welds, finds or computes normals, builds curves and patches. Keeps a copy of the mesh.
  static Result<Refiner> create(Mesh mesh, const RefineOptions& options = {});

  /// As limn::refine(); blending, normals and limits are those given to create().
  Result<Refinement> refine(const View& view, const LevelOptions& levels) const;

  /// From levels the caller chose. \pre one level an edge, each in [0, kMaxLevel]
  Result<Refinement> refine_with(std::span<const float> levels) const;

  const Mesh& mesh() const { return mesh_; }
  const Topology& topology() const { return topology_; }
  const std::vector<EdgeCurve>& curves() const { return curves_; }

 private:
  Refiner() = default;
  Mesh mesh_;
  Topology topology_;
  std::vector<Vec3> face_normals_;
  std::vector<EdgeCurve> curves_;
  TessellateOptions options_;
};

}  // namespace limn
