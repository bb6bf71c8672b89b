#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "limn/refine/levels.h"
#include "limn/render/refinement/method.h"

namespace limn {

/// The adaptive refinement kernel, Boubekeur and Schlick 2008 (docs/lenz-patterns.md): all N³ adaptive patterns [i, j,
/// k] of N levels lie on the device as faces use them, the mesh lies in the CPU's memory, and each triangle is drawn by
/// a call of its own, with its data set as uniforms.
///
/// Levels are whole, those of edge_levels() rounded up, nothing is blended, every vertex is on its patch: from equal
/// levels the triangles are those of ArkfpiMethod. A frame: two calls a face, its uniforms (192 bytes, 240 with
/// colours) and its triangles, in draw(); nothing is uploaded in refine(). Watertight bit for bit: edges are evaluated
/// by themselves.
class ArkMethod final : public RefinementMethod {
 public:
  /// \pre the scene has one instance, does not deform, outlives this and stays where it is
  /// Errors: kNoGraphics; those of edge_levels() for the options.
  static Result<ArkMethod> create(RefinementScene& scene, const LevelOptions& levels = {});
  ~ArkMethod() override;
  ArkMethod(ArkMethod&& other) noexcept;
  ArkMethod& operator=(ArkMethod&& other) noexcept;

  /// Levels the caller chose, from now on. \pre one an edge, each in [0, max_level]
  void give_levels(std::span<const float> levels);

  /// Errors: those of edge_levels() for the view.
  Result<void> refine(const View& view) override;
  Result<void> draw(const SurfacePass& pass) override;
  std::uint64_t triangle_count() const override;
  /// The patterns alone: the mesh is not on the device, but for what the scene keeps there.
  std::size_t device_bytes() const override;

  std::size_t stored_patterns() const;

 private:
  struct Impl;
  explicit ArkMethod(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace limn
