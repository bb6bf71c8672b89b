#include "clip_frames.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <epoxy/gl.h>

#include "limn/base/random.h"
#include "limn/gl/timer.h"

namespace limn::bench {
namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point begun) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begun).count();
}

/// Views from all around, the same for every contestant.
std::vector<Camera> cameras_of(const Bounds& bounds, const FrameSettings& settings) {
  Random random(settings.seed);
  std::vector<Camera> cameras;
  for (int i = 0; i < settings.views; ++i)
    cameras.push_back(fit_camera(bounds, random.direction()));
  for (Camera& camera : cameras) {  // the hull reaches beyond the bounds
    camera.near_distance *= 0.7f;
    camera.far_distance *= 1.2f;
  }
  return cameras;
}

/// What the contestants share.
struct Stage {
  CameraBuffer camera;
  RenderTargets plain, stencil, plain_4, stencil_4;
};

Result<Stage> make_stage(int size_px) {
  using Stencil = RenderTargets::Stencil;
  auto plain = RenderTargets::create(size_px, size_px, 1);
  auto stencil = RenderTargets::create(size_px, size_px, 1, Stencil::kEightBits);
  auto plain_4 = RenderTargets::create(size_px, size_px, 4);
  auto stencil_4 = RenderTargets::create(size_px, size_px, 4, Stencil::kEightBits);
  for (const auto* targets : {&plain, &stencil, &plain_4, &stencil_4}) {
    if (!*targets) return tl::unexpected(targets->error());
  }
  return Stage{CameraBuffer(), std::move(*plain), std::move(*stencil), std::move(*plain_4), std::move(*stencil_4)};
}

}  // namespace

Spread spread_of(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  return {values[values.size() / 2], values[values.size() / 4], values[values.size() - 1 - values.size() / 4]};
}

Result<PlainMesh> PlainMesh::create(gl::Context& context, const Mesh& mesh) {
  auto uploaded = GpuMesh::upload(mesh, mesh.positions);
  if (!uploaded) return tl::unexpected(uploaded.error());
  PlainMesh plain(std::move(*uploaded));
  auto materials = MaterialTable::create(mesh);
  if (!materials) return tl::unexpected(materials.error());
  plain.materials_ = std::make_unique<MaterialTable>(std::move(*materials));
  const auto program = context.program({"face.vert.glsl", "", "face.frag.glsl", {"SINGLE_MATERIAL 1"}});
  if (!program) return tl::unexpected(program.error());
  plain.program_ = *program;
  return plain;
}

void PlainMesh::draw(const RenderTargets& targets, const CameraBuffer& camera) const {
  targets.begin_faces();
  camera.bind();
  program_->use();
  program_->set("flat_normals", 0);
  program_->set("draw_faces", 1);
  materials_->bind();
  materials_->set_single(*program_);
  glVertexAttrib4f(3, 1.0f, 1.0f, 1.0f, 1.0f);
  glEnable(GL_CULL_FACE);
  glCullFace(GL_BACK);
  mesh_.draw();
  glDisable(GL_CULL_FACE);
}

Result<ClipRow> measure_row(gl::Context& context, const Subject& subject, const FrameSettings& settings) {
  const auto stage = make_stage(settings.size_px);
  if (!stage) return tl::unexpected(stage.error());
  const auto original = PlainMesh::create(context, subject.original);
  const auto simplified = PlainMesh::create(context, subject.simplified);
  auto model = ClipModel::create(context, subject.asset);
  auto frame = ClipFrame::create(context);
  if (!original || !simplified) return tl::unexpected((!original ? original : simplified).error());
  if (!model) return tl::unexpected(model.error());
  if (!frame) return tl::unexpected(frame.error());
  ClipDrawn drawn;
  Result<void> state;
  const auto plain = [&](const PlainMesh& mesh, const RenderTargets& targets, const Camera& camera) {
    stage->camera.update(make_camera_block(camera, settings.size_px, settings.size_px));
    mesh.draw(targets, stage->camera);
  };
  const auto clipped = [&](const RenderTargets& targets, const Camera& camera, const ClipDrawOptions& options) {
    frame->begin(targets, camera, options);
    auto done = frame->draw(*model);
    if (!done) state = tl::unexpected(done.error());
    if (done) drawn = *done;
    frame->end();
  };
  ClipDrawOptions options, lines, timed;
  options.level_tolerance_px = lines.level_tolerance_px = timed.level_tolerance_px = 0;
  lines.antialias = ClipAntialias::kLines;
  timed.time_stages = true;
  const std::vector<std::function<void(const Camera&)>> contestants = {
      [&](const Camera& camera) { plain(*original, stage->plain, camera); },
      [&](const Camera& camera) { plain(*simplified, stage->plain, camera); },
      [&](const Camera& camera) { clipped(stage->stencil, camera, options); },
      [&](const Camera& camera) { clipped(stage->stencil, camera, lines); },
      [&](const Camera& camera) { plain(*original, stage->plain_4, camera); },
      [&](const Camera& camera) { clipped(stage->stencil_4, camera, options); },
      [&](const Camera& camera) { clipped(stage->stencil, camera, timed); }};
  std::vector<std::vector<double>> times(contestants.size()), cpu_times(contestants.size()), stages(4), counts(3);
  const std::vector<Camera> cameras = cameras_of(subject.asset.bounds, settings);
  for (std::size_t view = 0; view < cameras.size(); ++view) {
    for (std::size_t c = 0; c < contestants.size(); ++c) {
      gl::finish();
      const Clock::time_point begun = Clock::now();
      const std::clock_t cpu_begun = std::clock();
      contestants[c](cameras[view]);
      gl::finish();
      if (!state) return tl::unexpected(state.error());
      if (view <= 1) continue;  // the first two views warm up
      times[c].push_back(ms_since(begun));
      cpu_times[c].push_back(1e3 * static_cast<double>(std::clock() - cpu_begun) / CLOCKS_PER_SEC);
    }
    if (view <= 1) continue;
    const double ms[] = {drawn.extraction_ms, drawn.loops_ms, drawn.stencil_ms, drawn.hull_ms};
    for (std::size_t i = 0; i < 4; ++i)
      stages[i].push_back(ms[i]);
    counts[0].push_back(static_cast<double>(drawn.silhouette_edges));
    counts[1].push_back(static_cast<double>(drawn.stencil_triangles));
    counts[2].push_back(static_cast<double>(drawn.edge_on_faces));
  }
  ClipRow row;
  row.name = subject.about.name;
  row.faces = subject.original.face_count();
  row.hull_faces = subject.asset.hull.face_count();
  Spread* const spreads[] = {&row.original, &row.simplified,    &row.clipped,
                             &row.lines,    &row.msaa_original, &row.msaa_clipped};
  for (std::size_t i = 0; i < 6; ++i)
    *spreads[i] = spread_of(times[i]);
  double* const cpu[] = {&row.cpu_original, &row.cpu_simplified,    &row.cpu_clipped,
                         &row.cpu_lines,    &row.cpu_msaa_original, &row.cpu_msaa_clipped};
  for (std::size_t i = 0; i < 6; ++i)
    *cpu[i] = spread_of(cpu_times[i]).median;
  double* const medians[] = {&row.extraction, &row.loops, &row.stencil, &row.hull};
  for (std::size_t i = 0; i < 4; ++i)
    *medians[i] = spread_of(stages[i]).median;
  row.silhouette_edges = spread_of(counts[0]).median;
  row.stencil_triangles = spread_of(counts[1]).median;
  row.edge_on_faces = spread_of(counts[2]).median;
  row.paper = subject.about.paper;
  return row;
}

namespace {

/// Milliseconds of one frame for each view after the first two, which warm up.
template <class DrawFrame>
Result<double> median_frame(const std::vector<Camera>& cameras, const DrawFrame& draw_frame) {
  std::vector<double> times;
  for (std::size_t view = 0; view < cameras.size(); ++view) {
    gl::finish();
    const Clock::time_point begun = Clock::now();
    if (const Result<void> drawn = draw_frame(cameras[view]); !drawn) return tl::unexpected(drawn.error());
    gl::finish();
    if (view > 1) times.push_back(ms_since(begun));
  }
  return spread_of(times).median;
}

}  // namespace

Result<double> time_plain(gl::Context& context, const Mesh& mesh, const Bounds& bounds, const FrameSettings& settings) {
  const auto plain = PlainMesh::create(context, mesh);
  if (!plain) return tl::unexpected(plain.error());
  const auto targets = RenderTargets::create(settings.size_px, settings.size_px, 1);
  if (!targets) return tl::unexpected(targets.error());
  const CameraBuffer camera_buffer;
  return median_frame(cameras_of(bounds, settings), [&](const Camera& camera) -> Result<void> {
    camera_buffer.update(make_camera_block(camera, settings.size_px, settings.size_px));
    plain->draw(*targets, camera_buffer);
    return {};
  });
}

Result<double> time_clipped(gl::Context& context, const ClipAsset& asset, const FrameSettings& settings) {
  auto model = ClipModel::create(context, asset);
  if (!model) return tl::unexpected(model.error());
  auto frame = ClipFrame::create(context);
  if (!frame) return tl::unexpected(frame.error());
  const auto targets = RenderTargets::create(settings.size_px, settings.size_px, 1, RenderTargets::Stencil::kEightBits);
  if (!targets) return tl::unexpected(targets.error());
  ClipDrawOptions options;
  options.level_tolerance_px = 0;
  return median_frame(cameras_of(asset.bounds, settings), [&](const Camera& camera) -> Result<void> {
    frame->begin(*targets, camera, options);
    auto drawn = frame->draw(*model);
    frame->end();
    if (!drawn) return tl::unexpected(drawn.error());
    return {};
  });
}

}  // namespace limn::bench
