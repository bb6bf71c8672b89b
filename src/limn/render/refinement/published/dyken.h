#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "limn/mesh/ids.h"
#include "limn/render/refinement/edge_levels.h"
#include "limn/render/refinement/method.h"
#include "limn/render/refinement/published/basis_table.h"

namespace limn {

struct DykenOptions {
  LevelOptions levels{};
  DykenBasis basis = DykenBasis::kNine;  ///< says what the center is, whatever the scene's options say
  /// Blend between the two levels around an edge's. If not, levels are rounded up: half the look-ups, and popping.
  bool blending = true;
};

/// The pipeline of Dyken et al. 2008, section 6, as published (docs/dyken-pipeline.md): for comparison with what came
/// later, since it reads back and draws triangle by triangle.
///
/// refine() finds the level of every edge and compacts, by histogram pyramids, the edges of triangles to be refined,
/// and of a deforming scene these triangles too. The first draw() after it draws the unrefined triangles, tagged ones
/// collapsed, then reads back what was compacted; each refined triangle is drawn as a pre-tessellated patch P_m whose
/// coefficients are uniforms (after Boubekeur and Schlick 2005), its points blended from tabulated basis functions.
///
/// From equal levels the points are those of sample_edge() and sample_interior() (refine/blend.h) for Blend::kPaper
/// within a few units in the last place, or the 12 bits of a packed basis. A point on an edge has the same bits from
/// both faces; where their m differ, the finer one has points that the other lacks: the paper's T-vertices, on a
/// segment but for rounding.
///
/// Of a deforming scene (RefinementSceneOptions::deforming) call RefinementScene::update_surface() after positions
/// changed and before refine().
///
/// A frame of n faces, r of them refined, costs: 3 dispatches (levels, tags, edges' data) and those of one
/// histogram pyramid over the edges (Compactor::run()); of a deforming scene one more and those of a pyramid over the
/// faces. Read-backs: 4 bytes, then 8 bytes for each edge of a refined triangle; deforming: 2 of 4 bytes, then 32 an
/// edge and 64 a face. Draw calls: 1 + r, each of the r after a call that sets 192 bytes of uniforms (208 with kTen).
/// Every further draw() of the frame costs the draw calls alone. Host memory: 208 bytes a face, deforming a refined
/// face.
class DykenMethod final : public RefinementMethod {
 public:
  /// \pre the scene has one object and one instance, outlives this and stays where it is
  /// Errors: kNoGraphics; those of edge_levels() for the options.
  static Result<DykenMethod> create(RefinementScene& scene, const DykenOptions& options = {});
  ~DykenMethod() override;
  DykenMethod(DykenMethod&& other) noexcept;
  DykenMethod& operator=(DykenMethod&& other) noexcept;

  /// Errors: those of edge_levels() for the view; kNoGraphics.
  Result<void> refine(const View& view) override;
  Result<void> draw(const SurfacePass& pass) override;
  /// Waits for the device if draw() has not yet.
  std::uint64_t triangle_count() const override;
  std::size_t device_bytes() const override;

  /// To give levels of one's own.
  EdgeLevelPass& levels();

  /// A triangle to be refined, and its topological level m.
  struct RefinedFace {
    FaceId face = 0;
    int level = 0;
  };
  /// In the order drawn: static scenes by their lowest edge with a level, deforming ones ascending. Waits as
  /// triangle_count().
  const std::vector<RefinedFace>& refined_faces() const;

 private:
  struct Impl;
  explicit DykenMethod(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace limn
