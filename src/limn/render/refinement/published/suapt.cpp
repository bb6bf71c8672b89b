#include "limn/render/refinement/published/suapt.h"

#include <algorithm>
#include <utility>

#include "limn/render/refinement/published/grouped_method.h"

namespace limn {
namespace {

GroupedDraws::Choice choose_level(const PatternSides& sides) {
  const std::uint32_t packed =
      sides[0] | static_cast<std::uint32_t>(sides[1]) << 4 | static_cast<std::uint32_t>(sides[2]) << 8;
  return {2u * *std::max_element(sides.begin(), sides.end()), packed};
}

}  // namespace

Result<SuaptMethod> SuaptMethod::create(RefinementScene& scene, const LevelOptions& levels) {
  auto impl = GroupedMethod::create(scene, levels, patterns_of_sides(uniform_sides(levels.max_level)),
                                    {"NESTED 0", "SNAPPED 1"});
  if (!impl) return tl::unexpected(impl.error());
  return SuaptMethod(std::move(*impl));
}

SuaptMethod::SuaptMethod(std::unique_ptr<GroupedMethod> impl) : impl_(std::move(impl)) {}
SuaptMethod::~SuaptMethod() = default;
SuaptMethod::SuaptMethod(SuaptMethod&&) noexcept = default;
SuaptMethod& SuaptMethod::operator=(SuaptMethod&&) noexcept = default;

void SuaptMethod::give_levels(std::span<const float> levels) {
  impl_->levels.give(levels);
}

Result<void> SuaptMethod::refine(const View& view) {
  return impl_->refine(view, choose_level);
}

Result<void> SuaptMethod::draw(const SurfacePass& pass) {
  return impl_->draws.draw(pass);
}

std::uint64_t SuaptMethod::triangle_count() const {
  return impl_->draws.triangle_count();
}

std::size_t SuaptMethod::device_bytes() const {
  return impl_->device_bytes();
}

std::size_t SuaptMethod::call_count() const {
  return impl_->draws.groups().size();
}

}  // namespace limn
