#include "limn/render/refinement/patterns.h"

#include <utility>

#include "limn/gl/compute.h"

namespace limn {
namespace {

constexpr unsigned kLevelsUnit = 11, kCutUnit = 12;  // refine_vertex.glsl

}  // namespace

Result<PatternMethod> PatternMethod::create(RefinementScene& scene, const PatternMethodOptions& options) {
  scene.context().make_current();
  PatternMethod method;
  method.scene_ = &scene;
  method.options_ = options;
  auto levels = EdgeLevelPass::create(scene, options.levels);
  if (!levels) return tl::unexpected(levels.error());
  method.levels_ = std::make_unique<EdgeLevelPass>(std::move(*levels));
  auto patterns = PatternBuffers::create(pattern_table(options.family, options.levels.max_level));
  if (!patterns) return tl::unexpected(patterns.error());
  method.patterns_ = std::make_unique<PatternBuffers>(std::move(*patterns));
  auto selection = PatternSelection::create(scene, options.family, *method.patterns_, options.levels.max_level);
  if (!selection) return tl::unexpected(selection.error());
  method.selection_ = std::make_unique<PatternSelection>(std::move(*selection));
  return method;
}

Result<void> PatternMethod::refine(const View& view) {
  for (const Refiner* object : scene_->objects()) {
    if (auto good = check_levels(object->mesh(), view, options_.levels); !good) return tl::unexpected(good.error());
  }
  scene_->context().make_current();
  scene_->set_view(view);
  levels_->run();
  selection_->run(*levels_, options_.triangle_budget);
  return {};
}

Result<void> PatternMethod::draw(const SurfacePass& pass) {
  scene_->bind();
  gl::bind_texture(kLevelsUnit, levels_->texture());
  gl::bind_texture(kCutUnit, selection_->cut());
  if (auto coarse = coarse_programs_.use(*scene_, pass); !coarse) return tl::unexpected(coarse.error());
  draw_hooked(pass, [&] { selection_->draw_coarse(); });
  const auto refined = refined_programs_.use(*scene_, pass);
  if (!refined) return tl::unexpected(refined.error());
  (*refined)->set("paper_blend", options_.blend == Blend::kPaper ? 1 : 0);
  (*refined)->set("mean_center", scene_->options().center == CenterRule::kMean ? 1 : 0);
  draw_hooked(pass, [&] { selection_->draw_refined(); });
  return {};
}

std::size_t PatternMethod::device_bytes() const {
  return scene_->table_bytes() + levels_->bytes() + selection_->bytes() + patterns_->bytes();
}

}  // namespace limn
