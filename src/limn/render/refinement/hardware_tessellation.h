#pragma once

#include <memory>

#include "limn/gl/objects.h"
#include "limn/render/refinement/edge_levels.h"
#include "limn/render/refinement/method.h"

namespace limn {

/// Where the device's tessellator puts vertices on a side.
enum class TessellationSpacing {
  kEqual,           ///< 2^⌈s⌉ equal segments: the patterns' vertices on edges
  kFractionalOdd,   ///< 2^s segments, two of them growing in; levels are not blended besides
  kFractionalEven,  ///< the same, never fewer than two: no face stays unrefined
};

struct HardwareTessellationOptions {
  LevelOptions levels{};
  TessellationSpacing spacing = TessellationSpacing::kEqual;
};

/// The device's own tessellation stages on the same Bézier patches and edge levels as PatternMethod: the baseline to
/// beat (docs/refinement-bench.md). All faces are patches of one call; inside, a patch has as many segments as on its
/// finest side.
///
/// A point on an edge comes from the edge's own curve and level, so that faces on both sides find the same bits; with
/// kEqual, and instances that are not moved, they are those of PatternMethod. Control points are put in world space
/// before patches are evaluated, once a patch. Inside, points lie on the patch: the tessellator's are on no dyadic
/// grid, so there is nothing to blend between.
class HardwareTessellationMethod final : public RefinementMethod {
 public:
  /// Memory on the device: 12 bytes a face, 4 an edge. \pre the scene outlives it and stays where it is
  /// Errors: kInvalidArgument when 2^max_level is more than the device divides a side into (64 at least); kNoGraphics;
  /// those of edge_levels() for the options.
  static Result<HardwareTessellationMethod> create(RefinementScene& scene,
                                                   const HardwareTessellationOptions& options = {});

  /// Errors: those of edge_levels() for the view.
  Result<void> refine(const View& view) override;
  Result<void> draw(const SurfacePass& pass) override;
  /// From the levels, as OpenGL 4.5 section 11.2.2 divides triangles.
  std::uint64_t triangle_count() const override;
  std::size_t device_bytes() const override;

  EdgeLevelPass& levels() { return *levels_; }

 private:
  HardwareTessellationMethod(RefinementScene& scene, const HardwareTessellationOptions& options);
  RefinementScene* scene_ = nullptr;
  HardwareTessellationOptions options_;
  std::unique_ptr<EdgeLevelPass> levels_;
  gl::Buffer corners_;
  gl::VertexArray array_;
  SurfacePrograms programs_;
};

/// Triangles that OpenGL makes of a triangular patch: `sides` and `inner` are levels as a control stage writes them,
/// none above the device's largest.
std::uint64_t tessellator_triangles(TessellationSpacing spacing, const float (&sides)[3], float inner);

}  // namespace limn
