#include "limn/render/refinement/published/arkfpi.h"

#include <utility>

#include "limn/render/refinement/published/grouped_method.h"

namespace limn {
namespace {

GroupedDraws::Choice choose_base(const PatternSides& sides) {
  const PatternChoice choice = choose_pattern(PatternFamily::kMinimal, {0, sides});
  const std::uint8_t* const corners = kCornerOf[choice.permutation];
  return {2 * choice.base + (choice.mirrored ? 1u : 0u), std::uint32_t{corners[0]} | std::uint32_t{corners[1]} << 2};
}

}  // namespace

Result<ArkfpiMethod> ArkfpiMethod::create(RefinementScene& scene, const LevelOptions& levels) {
  auto impl =
      GroupedMethod::create(scene, levels, pattern_table(PatternFamily::kMinimal, levels.max_level), {"NESTED 0"});
  if (!impl) return tl::unexpected(impl.error());
  return ArkfpiMethod(std::move(*impl));
}

ArkfpiMethod::ArkfpiMethod(std::unique_ptr<GroupedMethod> impl) : impl_(std::move(impl)) {}
ArkfpiMethod::~ArkfpiMethod() = default;
ArkfpiMethod::ArkfpiMethod(ArkfpiMethod&&) noexcept = default;
ArkfpiMethod& ArkfpiMethod::operator=(ArkfpiMethod&&) noexcept = default;

void ArkfpiMethod::give_levels(std::span<const float> levels) {
  impl_->levels.give(levels);
}

Result<void> ArkfpiMethod::refine(const View& view) {
  return impl_->refine(view, choose_base);
}

Result<void> ArkfpiMethod::draw(const SurfacePass& pass) {
  return impl_->draws.draw(pass);
}

std::uint64_t ArkfpiMethod::triangle_count() const {
  return impl_->draws.triangle_count();
}

std::size_t ArkfpiMethod::device_bytes() const {
  return impl_->device_bytes();
}

std::vector<ArkfpiMethod::Group> ArkfpiMethod::groups() const {
  std::vector<Group> groups;
  for (const GroupedDraws::Group& group : impl_->draws.groups())
    groups.push_back({group.group / 2, group.group % 2 != 0, group.count});
  return groups;
}

std::size_t ArkfpiMethod::stored_patterns() const {
  return impl_->draws.patterns().size();
}

std::size_t ArkfpiMethod::pattern_bytes() const {
  return impl_->draws.patterns().bytes();
}

}  // namespace limn
