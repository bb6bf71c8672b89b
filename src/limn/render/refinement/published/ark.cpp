#include "limn/render/refinement/published/ark.h"

#include <utility>
#include <vector>

#include "limn/render/refinement/published/per_triangle.h"
#include "limn/render/refinement/published/side_patterns.h"
#include "limn/render/refinement/published/whole_levels.h"

namespace limn {

struct ArkMethod::Impl {
  RefinementScene* scene;
  WholeLevels levels;
  PerTriangleDraws draws;
  std::vector<std::uint32_t> chosen = {};  // a pattern a face

  ~Impl() { scene->context().make_current(); }  // what the members delete is this context's
};

Result<ArkMethod> ArkMethod::create(RefinementScene& scene, const LevelOptions& options) {
  scene.context().make_current();
  auto levels = WholeLevels::create(scene, options);
  if (!levels) return tl::unexpected(levels.error());
  auto draws = PerTriangleDraws::create(scene, patterns_of_sides(all_sides(options.max_level)));
  if (!draws) return tl::unexpected(draws.error());
  return ArkMethod(std::unique_ptr<Impl>(new Impl{&scene, std::move(*levels), std::move(*draws)}));
}

ArkMethod::ArkMethod(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ArkMethod::~ArkMethod() = default;
ArkMethod::ArkMethod(ArkMethod&&) noexcept = default;
ArkMethod& ArkMethod::operator=(ArkMethod&&) noexcept = default;

void ArkMethod::give_levels(std::span<const float> levels) {
  impl_->levels.give(levels);
}

Result<void> ArkMethod::refine(const View& view) {
  if (auto decided = impl_->levels.decide(view); !decided) return tl::unexpected(decided.error());
  impl_->scene->context().make_current();
  impl_->scene->set_view(view);
  const auto n = static_cast<std::uint32_t>(impl_->levels.options().max_level) + 1;
  impl_->chosen.assign(impl_->levels.topology().face_count(), PerTriangleDraws::kNotDrawn);
  for (FaceId f = 0; f < impl_->chosen.size(); ++f) {
    if (!impl_->levels.draws(f)) continue;
    const auto [i, j, k] = impl_->levels.sides(f);
    impl_->chosen[f] = (i * n + j) * n + k;
  }
  return {};
}

Result<void> ArkMethod::draw(const SurfacePass& pass) {
  return impl_->draws.draw(pass, impl_->chosen);
}

std::uint64_t ArkMethod::triangle_count() const {
  return impl_->draws.triangle_count(impl_->chosen);
}

std::size_t ArkMethod::device_bytes() const {
  return impl_->draws.patterns().bytes();
}

std::size_t ArkMethod::stored_patterns() const {
  return impl_->draws.patterns().size();
}

}  // namespace limn
