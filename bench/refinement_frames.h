#pragma once

#include <memory>
#include <string>
#include <vector>

#include "limn/gl/context.h"
#include "limn/refine/refine.h"
#include "limn/render/camera_block.h"
#include "limn/render/materials.h"
#include "limn/render/refinement/method.h"
#include "limn/render/targets.h"

namespace limn::bench {

/// A way to draw, taking part in a comparison.
struct Contestant {
  std::string name;
  std::unique_ptr<RefinementMethod> method;
  RefinementScene* deforming = nullptr;  ///< update_surface() is part of its frame
  bool held = false;                     ///< refine() is not, after the first
};

/// What a contestant's frames took: refine() and draw() until the device was done.
struct FrameTimes {
  std::string name;
  double median_ms = 0, low_ms = 0, high_ms = 0;  ///< quartiles
  std::uint64_t triangles = 0;
  std::size_t device_bytes = 0;
};

struct FrameOptions {
  int size_px = 512;
  int least_rounds = 3, most_rounds = 15;
  double budget_s = 2.0;  ///< no new round after this
  SurfaceStage stage = SurfaceStage::kShaded;
  bool rasterize = true;
};

/// A mesh on the device and a picture to draw it into, seen from eyes that go around it.
class FrameStage {
 public:
  static Result<std::unique_ptr<FrameStage>> create(gl::Context& context, const Mesh& mesh);

  const Refiner& refiner() const { return refiner_; }
  /// The mesh as a scene that does not move, or one whose positions live on the device; made when first asked for.
  Result<RefinementScene*> scene(bool deforming = false);

  /// Times the contestants in turn, round by round: each round all of them draw the same view. One round before does
  /// not count.
  Result<std::vector<FrameTimes>> time(std::vector<Contestant>& contestants, const FrameOptions& options);

 private:
  FrameStage(gl::Context& context, Refiner refiner) : context_(&context), refiner_(std::move(refiner)) {}
  Result<void> draw_frame(Contestant& contestant, int round, const FrameOptions& options, const RenderTargets& targets);
  gl::Context* context_;
  Refiner refiner_;
  std::unique_ptr<RefinementScene> still_, deforming_;
  std::unique_ptr<MaterialTable> materials_;
  CameraBuffer camera_;
};

}  // namespace limn::bench
