#include "limn/render/refinement/published/grouped_method.h"

#include <utility>

namespace limn {

Result<std::unique_ptr<GroupedMethod>> GroupedMethod::create(RefinementScene& scene, const LevelOptions& options,
                                                             const PatternTable& table,
                                                             std::vector<std::string> defines) {
  scene.context().make_current();
  auto levels = WholeLevels::create(scene, options);
  if (!levels) return tl::unexpected(levels.error());
  auto draws = GroupedDraws::create(scene, table, std::move(defines));
  if (!draws) return tl::unexpected(draws.error());
  return std::unique_ptr<GroupedMethod>(new GroupedMethod{&scene, std::move(*levels), std::move(*draws)});
}

GroupedMethod::~GroupedMethod() {
  scene->context().make_current();  // what the members delete is this context's
}

Result<void> GroupedMethod::refine(const View& view,
                                   const std::function<GroupedDraws::Choice(const PatternSides&)>& choose) {
  if (auto decided = levels.decide(view); !decided) return tl::unexpected(decided.error());
  scene->context().make_current();
  scene->set_view(view);
  std::vector<GroupedDraws::Choice> choices(levels.topology().face_count());
  for (FaceId f = 0; f < choices.size(); ++f) {
    if (levels.draws(f)) choices[f] = choose(levels.sides(f));
  }
  draws.arrange(choices);
  return {};
}

}  // namespace limn
