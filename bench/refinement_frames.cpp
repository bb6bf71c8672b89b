#include "refinement_frames.h"

#include <algorithm>
#include <chrono>
#include <epoxy/gl.h>
#include <utility>

#include "limn/gl/timer.h"

namespace limn::bench {
namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point begun) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begun).count();
}

void summarize(std::vector<double>& times, FrameTimes& result) {
  std::sort(times.begin(), times.end());
  result.median_ms = times[times.size() / 2];
  result.low_ms = times[times.size() / 4];
  result.high_ms = times[times.size() - 1 - times.size() / 4];
}

}  // namespace

Result<std::unique_ptr<FrameStage>> FrameStage::create(gl::Context& context, const Mesh& mesh) {
  context.make_current();
  auto refiner = Refiner::create(mesh);
  if (!refiner) return tl::unexpected(refiner.error());
  std::unique_ptr<FrameStage> stage(new FrameStage(context, std::move(*refiner)));
  auto materials = MaterialTable::create(stage->refiner_.mesh());
  if (!materials) return tl::unexpected(materials.error());
  stage->materials_ = std::make_unique<MaterialTable>(std::move(*materials));
  return stage;
}

Result<RefinementScene*> FrameStage::scene(bool deforming) {
  std::unique_ptr<RefinementScene>& kept = deforming ? deforming_ : still_;
  if (!kept) {
    auto made = RefinementScene::create(*context_, refiner_, {.deforming = deforming});
    if (!made) return tl::unexpected(made.error());
    kept = std::make_unique<RefinementScene>(std::move(*made));
  }
  return kept.get();
}

Result<void> FrameStage::draw_frame(Contestant& contestant, int round, const FrameOptions& options,
                                    const RenderTargets& targets) {
  const Camera camera = fit_camera(face_bounds(refiner_.mesh()), 0.5f + 0.1f * static_cast<float>(round), 0.4f);
  camera_.update(make_camera_block(camera, options.size_px, options.size_px));
  camera_.bind();
  materials_->bind();
  targets.begin_faces();
  if (contestant.deforming != nullptr) contestant.deforming->update_surface();
  if (round == 0 || !contestant.held) {
    auto refined = contestant.method->refine(view_of(camera, options.size_px));
    if (!refined) return refined;
  }
  return contestant.method->draw({.stage = options.stage});
}

Result<std::vector<FrameTimes>> FrameStage::time(std::vector<Contestant>& contestants, const FrameOptions& options) {
  // Where nothing is drawn, clearing a picture would be most of a small mesh's frame.
  const int side_px = options.rasterize ? options.size_px : 16;
  const auto targets = RenderTargets::create(side_px, side_px, 1);
  if (!targets) return tl::unexpected(targets.error());
  std::vector<std::vector<double>> times(contestants.size());
  if (!options.rasterize) glEnable(GL_RASTERIZER_DISCARD);
  Clock::time_point begun = Clock::now();
  for (int round = 0; round <= options.most_rounds; ++round) {
    if (round > options.least_rounds && ms_since(begun) > 1e3 * options.budget_s) break;
    for (std::size_t c = 0; c < contestants.size(); ++c) {
      gl::finish();
      const Clock::time_point frame = Clock::now();
      auto drawn = draw_frame(contestants[c], round, options, *targets);
      gl::finish();
      if (!drawn) {
        glDisable(GL_RASTERIZER_DISCARD);
        return tl::unexpected(drawn.error());
      }
      if (round > 0) times[c].push_back(ms_since(frame));
    }
    if (round == 0) begun = Clock::now();
  }
  glDisable(GL_RASTERIZER_DISCARD);
  std::vector<FrameTimes> results;
  for (std::size_t c = 0; c < contestants.size(); ++c) {
    FrameTimes result{.name = contestants[c].name};
    summarize(times[c], result);
    result.triangles = contestants[c].method->triangle_count();
    result.device_bytes = contestants[c].method->device_bytes();
    results.push_back(std::move(result));
  }
  return results;
}

}  // namespace limn::bench
