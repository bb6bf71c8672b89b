#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "limn/refine/levels.h"
#include "limn/render/refinement/method.h"

namespace limn {

struct DmrOptions {
  LevelOptions levels{};
  /// The most triangles that one of the geometry stage's invocations writes, 2 … 32: more means fewer passes, but how
  /// many were promised is what a geometry stage's speed hangs on.
  int triangles_a_pass = 8;
};

/// Dynamic mesh refinement, Lorenz and Döllner 2008 (docs/lenz-patterns.md): the refined mesh itself lies on the
/// device, as corners that name their face and their place on it. A frame makes it from that of the frame before: a
/// geometry stage looks up the pattern that the face asks for now, each of the face's n old triangles copies its share
/// of the pattern's triangles (t, t + n, t + 2n …, none where the pattern has fewer) and transform feedback catches
/// them. An invocation writes few triangles, so there are several passes; the last mesh is drawn by a vertex stage.
///
/// Levels are decided on the device and rounded up, nothing is blended, every vertex is on its patch: from equal levels
/// the triangles are those of ArkfpiMethod. A frame: a fixed number of calls, pass_count() and two more, and nothing is
/// read back. Watertight bit for bit: edges are evaluated by themselves. The triangles are not indexed: each corner is
/// evaluated anew.
class DmrMethod final : public RefinementMethod {
 public:
  /// Memory on the device: two meshes of 4^max_level triangles a face, 36 bytes each: what small levels were meant for.
  /// \pre the scene has one instance, does not deform, outlives this and stays where it is
  /// Errors: kInvalidArgument; kNoGraphics; those of edge_levels() for the options.
  static Result<DmrMethod> create(RefinementScene& scene, const DmrOptions& options = {});
  ~DmrMethod() override;
  DmrMethod(DmrMethod&& other) noexcept;
  DmrMethod& operator=(DmrMethod&& other) noexcept;

  /// Levels the caller chose, from now on. \pre one an edge, each in [0, max_level]
  void give_levels(std::span<const float> levels);

  /// Errors: those of edge_levels() for the view.
  Result<void> refine(const View& view) override;
  Result<void> draw(const SurfacePass& pass) override;
  /// Waits for the device.
  std::uint64_t triangle_count() const override;
  std::size_t device_bytes() const override;

  /// How often a frame runs the geometry stage: the least p with triangles_a_pass^p >= 4^max_level.
  int pass_count() const;

 private:
  struct Impl;
  explicit DmrMethod(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace limn
