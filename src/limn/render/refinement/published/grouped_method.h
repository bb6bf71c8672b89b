#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "limn/gl/context.h"
#include "limn/render/refinement/published/grouped_draws.h"
#include "limn/render/refinement/published/side_patterns.h"
#include "limn/render/refinement/published/whole_levels.h"

namespace limn {

/// What a method has whose faces the CPU arranges in groups, by whole levels.
struct GroupedMethod {
  /// \param defines  of refine_grouped.vert.glsl. Errors: those of its parts. \pre as they have
  static Result<std::unique_ptr<GroupedMethod>> create(RefinementScene& scene, const LevelOptions& options,
                                                       const PatternTable& table, std::vector<std::string> defines);
  ~GroupedMethod();

  /// Decides the levels and arranges the faces. \param choose  what a face with these sides asks for
  Result<void> refine(const View& view, const std::function<GroupedDraws::Choice(const PatternSides&)>& choose);
  std::size_t device_bytes() const { return scene->table_bytes() + draws.bytes(); }

  RefinementScene* scene;
  WholeLevels levels;
  GroupedDraws draws;
};

}  // namespace limn
