#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "limn/refine/levels.h"
#include "limn/render/refinement/method.h"

namespace limn {

struct GroupedMethod;

/// Semi-uniform adaptive patch tessellation, Dyken, Reimers and Seland 2009 (docs/lenz-patterns.md): a face is drawn as
/// the uniform pattern of the largest of its sides' levels, and the vertex stage moves what lies on a finer border to
/// the nearest of the side's own 2^s points, so that neighbours meet. One instanced call a level.
///
/// Levels are whole, those of edge_levels() rounded up. Triangles between points that were moved to one place are drawn
/// all the same and cover nothing: a face of level m has 4^m triangles, whatever its sides ask for. A side of one
/// segment beside finer ones takes abrupt triangles. A frame: an upload of 8 bytes a face in refine(), at most
/// max_level + 1 calls in draw(). Watertight bit for bit: edges are evaluated by themselves.
class SuaptMethod final : public RefinementMethod {
 public:
  /// \pre the scene has one instance, does not deform, outlives this and stays where it is
  /// Errors: kNoGraphics; those of edge_levels() for the options.
  static Result<SuaptMethod> create(RefinementScene& scene, const LevelOptions& levels = {});
  ~SuaptMethod() override;
  SuaptMethod(SuaptMethod&& other) noexcept;
  SuaptMethod& operator=(SuaptMethod&& other) noexcept;

  /// Levels the caller chose, from now on. \pre one an edge, each in [0, max_level]
  void give_levels(std::span<const float> levels);

  /// Errors: those of edge_levels() for the view.
  Result<void> refine(const View& view) override;
  Result<void> draw(const SurfacePass& pass) override;
  /// Those that cover nothing included.
  std::uint64_t triangle_count() const override;
  std::size_t device_bytes() const override;

  /// Calls that draw() makes.
  std::size_t call_count() const;

 private:
  explicit SuaptMethod(std::unique_ptr<GroupedMethod> impl);
  std::unique_ptr<GroupedMethod> impl_;
};

}  // namespace limn
