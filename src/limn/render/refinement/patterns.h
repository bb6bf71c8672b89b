#pragma once

#include <memory>

#include "limn/refine/blend.h"
#include "limn/refine/patterns/pattern.h"
#include "limn/render/refinement/edge_levels.h"
#include "limn/render/refinement/method.h"
#include "limn/render/refinement/pattern_buffers.h"
#include "limn/render/refinement/pattern_selection.h"
#include "limn/render/refinement/stored_surface.h"

namespace limn {

struct PatternMethodOptions {
  LevelOptions levels{};
  PatternFamily family = PatternFamily::kNested;
  Blend blend = Blend::kSurplus;
  /// The most triangles a frame draws, 0 for no such bound; never below the scene's own (PatternSelection::run()).
  std::uint64_t triangle_budget = 0;
  /// Where the surface's points are computed: in the vertex stage of every pass, which needs no memory for them; or
  /// once a frame into memory (StoredSurface), for the passes to draw from. Storing needs a bound: the budget, or where
  /// there is none kStoredTriangles, or fewer if the device's buffers hold fewer; a frame that would exceed it is cut
  /// as for a budget.
  bool store = false;
  bool store_attributes = true;  ///< false: for passes of positions alone
};

inline constexpr std::uint64_t kStoredTriangles = 2'000'000;

/// The default way to draw a scene refined: everything is decided and drawn on the graphics device, with a fixed number
/// of calls whatever the scene, and nothing is read back (docs/gpu-refinement.md). Stored patterns (Lenz et al. 2009)
/// carry the adaptively blended surface (Dyken et al. 2008): from equal levels the triangles are those of tessellate()
/// (refine/tessellate.h) for the same family, their points within a few units in the last place, and points on edges
/// the same bits from all faces there.
class PatternMethod final : public RefinementMethod {
 public:
  /// \pre the scene outlives it and stays where it is. Errors: kNoGraphics; those of edge_levels() for the options.
  static Result<PatternMethod> create(RefinementScene& scene, const PatternMethodOptions& options = {});

  /// Errors: those of edge_levels() for the view.
  Result<void> refine(const View& view) override;
  Result<void> draw(const SurfacePass& pass) override;
  std::uint64_t triangle_count() const override { return selection_->triangle_count(); }
  std::size_t device_bytes() const override;

  EdgeLevelPass& levels() { return *levels_; }
  const PatternSelection& selection() const { return *selection_; }

  /// What was refined, read back as a mesh in world space, one value of each attribute a vertex; waits for the device.
  /// Unrefined triangles first, then by pattern. Errors: kUnsuitable unless made with `store`.
  Result<Mesh> read() const;

  const PatternBuffers& patterns() const { return *patterns_; }

 private:
  PatternMethod() = default;
  RefinementScene* scene_ = nullptr;
  PatternMethodOptions options_;
  std::unique_ptr<PatternBuffers> patterns_;  // where the selection finds them, wherever this object goes
  std::unique_ptr<EdgeLevelPass> levels_;
  std::unique_ptr<PatternSelection> selection_;
  std::unique_ptr<StoredSurface> stored_;
  SurfacePrograms coarse_programs_{{.vertex = "refine_coarse.vert.glsl"}};
  SurfacePrograms refined_programs_{{}};
};

}  // namespace limn
