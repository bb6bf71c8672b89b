#include "limn/render/refinement/patterns.h"

#include <algorithm>
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
  auto patterns = PatternBuffers::create(pattern_table(options.family, options.levels.max_level), options.store);
  if (!patterns) return tl::unexpected(patterns.error());
  method.patterns_ = std::make_unique<PatternBuffers>(std::move(*patterns));
  auto selection = PatternSelection::create(scene, options.family, *method.patterns_, options.levels.max_level);
  if (!selection) return tl::unexpected(selection.error());
  method.refined_programs_ =
      SurfacePrograms({.vertex = "refine_pattern.vert.glsl", .defines = {nested_define(options.family)}});
  method.selection_ = std::make_unique<PatternSelection>(std::move(*selection));
  if (!options.store) return method;
  std::uint64_t bound = options.triangle_budget;
  if (bound == 0) {
    const std::uint64_t room = StoredSurface::most_triangles(scene, *method.patterns_, options.store_attributes);
    bound = std::min(kStoredTriangles, room);
  }
  StoredSurfaceOptions stored;
  stored.family = options.family;
  stored.blend = options.blend;
  stored.attributes = options.store_attributes;
  stored.max_triangles = std::max<std::uint64_t>(bound, scene.triangle_count());
  // Where even the finest patterns for every face fit, nothing needs to be cut.
  const std::uint64_t most = scene.triangle_count() << (2 * options.levels.max_level);
  if (most <= stored.max_triangles)
    stored.max_triangles = most;
  else
    method.options_.triangle_budget = stored.max_triangles;
  auto made = StoredSurface::create(scene, *method.patterns_, *method.selection_, stored);
  if (!made) return tl::unexpected(made.error());
  method.stored_ = std::make_unique<StoredSurface>(std::move(*made));
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
  if (stored_) stored_->run(*levels_, *selection_);
  return {};
}

Result<void> PatternMethod::draw(const SurfacePass& pass) {
  scene_->bind();
  gl::bind_texture(kLevelsUnit, levels_->texture());
  gl::bind_texture(kCutUnit, selection_->cut());
  if (auto coarse = coarse_programs_.use(*scene_, pass); !coarse) return tl::unexpected(coarse.error());
  draw_hooked(pass, [&] { selection_->draw_coarse(); });
  if (stored_) return stored_->draw(*selection_, pass);
  const auto refined = refined_programs_.use(*scene_, pass);
  if (!refined) return tl::unexpected(refined.error());
  (*refined)->set("paper_blend", options_.blend == Blend::kPaper ? 1 : 0);
  (*refined)->set("mean_center", scene_->options().center == CenterRule::kMean ? 1 : 0);
  draw_hooked(pass, [&] { selection_->draw_refined(); });
  return {};
}

std::size_t PatternMethod::device_bytes() const {
  return scene_->table_bytes() + levels_->bytes() + selection_->bytes() + patterns_->bytes() +
         (stored_ ? stored_->bytes() : 0);
}

Result<Mesh> PatternMethod::read() const {
  if (!stored_) return fail(ErrorCode::kUnsuitable, "what was refined is not stored", "make the method with `store`");
  return stored_->read(*selection_);
}

}  // namespace limn
