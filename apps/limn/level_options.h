#pragma once

#include "limn/refine/refine.h"

#include "camera_options.h"
#include "option_table.h"

namespace limn::cli {

/// How a mesh is refined: the flags that refine, render and compare share.
struct LevelFlags {
  int max_level = 3;
  double pixels = 0;
  Criterion criterion = Criterion::kSilhouette;
  Wedge::Rule wedge_rule = Wedge::Rule::kAngle;
  double wedge_deg = 20;
  Blend blend = Blend::kSurplus;
  PatternFamily family = PatternFamily::kNested;
  CenterRule center = CenterRule::kPn;
  double crease_deg = 60;
  bool compute_normals = false;
  double near_distance = 0;
  double far_distance = 0;

  /// Whether levels depend on where the mesh is seen from.
  bool needs_eye() const;
};

void add_level_options(OptionTable& table, LevelFlags& flags);

/// Errors: kInvalidArgument for distances that contradict each other.
Result<void> check_levels(const LevelFlags& flags);

RefineOptions refine_options(const LevelFlags& flags, const Progress& progress);

std::string_view criterion_name(Criterion criterion);

}  // namespace limn::cli
