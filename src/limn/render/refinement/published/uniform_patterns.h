#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "limn/render/refinement/method.h"

namespace limn {

/// Generic mesh refinement, Boubekeur and Schlick 2005 (docs/lenz-patterns.md): one uniform pattern for all faces, each
/// drawn by a call of its own, with its data set as uniforms from the CPU's memory.
///
/// Every vertex is on its patch. A frame: two calls a face, its uniforms (192 bytes, 240 with colours) and its 4^level
/// triangles. Watertight bit for bit: edges are evaluated by themselves.
class UniformPatternsMethod final : public RefinementMethod {
 public:
  /// \param level  all edges have 2^level segments
  /// \pre the scene has one instance, does not deform, outlives this and stays where it is
  /// Errors: kInvalidArgument unless the level is in [0, kMaxLevel]; kNoGraphics.
  static Result<UniformPatternsMethod> create(RefinementScene& scene, int level = 3);
  ~UniformPatternsMethod() override;
  UniformPatternsMethod(UniformPatternsMethod&& other) noexcept;
  UniformPatternsMethod& operator=(UniformPatternsMethod&& other) noexcept;

  /// Decides nothing.
  Result<void> refine(const View& view) override;
  Result<void> draw(const SurfacePass& pass) override;
  std::uint64_t triangle_count() const override;
  /// The pattern alone: the mesh is not on the device, but for what the scene keeps there.
  std::size_t device_bytes() const override;

 private:
  struct Impl;
  explicit UniformPatternsMethod(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace limn
