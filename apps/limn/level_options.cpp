#include "level_options.h"

namespace limn::cli {
namespace {

constexpr double kRadians = 0.017453292519943295;

}  // namespace

bool LevelFlags::needs_eye() const {
  return criterion == Criterion::kSilhouette || criterion == Criterion::kDistance || pixels > 0;
}

void add_level_options(OptionTable& table, LevelFlags& flags) {
  table.begin(Group::kLevels);
  table.integer("--max-level", flags.max_level, 0, kMaxLevel, "deepest level M, 2^M segments an edge (default 3)");
  table.number("--pixels", "PX", flags.pixels, {0.0, 1e6, true, false},
               "refine until edges are this near their curves in the picture");
  table.choice("--criterion", flags.criterion,
               {{"silhouette", Criterion::kSilhouette},
                {"distance", Criterion::kDistance},
                {"curvature", Criterion::kCurvature},
                {"uniform", Criterion::kUniform},
                {"tags", Criterion::kTags}},
               "where (default silhouette)");
  table.choice("--beta", flags.wedge_rule, {{"angle", Wedge::Rule::kAngle}, {"quarter", Wedge::Rule::kQuarter}},
               "width of the band along the outline (default angle)");
  table.number("--wedge", "DEG", flags.wedge_deg, {0.0, 90.0, true, true}, "half the band's angle (default 20)");
  table.choice("--blend", flags.blend, {{"surplus", Blend::kSurplus}, {"paper", Blend::kPaper}},
               "between levels (default surplus)");
  table.choice("--topology", flags.family, {{"nested", PatternFamily::kNested}, {"minimal", PatternFamily::kMinimal}},
               "triangles of a face (default nested)");
  table.choice("--center", flags.center, {{"pn", CenterRule::kPn}, {"mean", CenterRule::kMean}},
               "a patch's middle point (default pn)");
  table.choice("--normals", flags.compute_normals, {{"file", false}, {"compute", true}},
               "the file's, or computed anew (default file)");
  table.number("--crease-angle", "DEG", flags.crease_deg, {0.0, 180.0, false, false},
               "computed normals split at sharper edges (default 60)");
  table.number("--near", "D", flags.near_distance, {0.0, 1e30, true, false}, "distance: full level up to here");
  table.number("--far", "D", flags.far_distance, {0.0, 1e30, true, false}, "distance: level 0 from here");
}

Result<void> check_levels(const LevelFlags& flags) {
  const bool any = flags.near_distance > 0 || flags.far_distance > 0;
  if (any && flags.criterion != Criterion::kDistance) {
    return fail(ErrorCode::kInvalidArgument, "--near and --far are for --criterion distance",
                "add it or leave them out");
  }
  if (any && flags.near_distance >= flags.far_distance) {
    return fail(ErrorCode::kInvalidArgument, "--near must be below --far", "give both");
  }
  return {};
}

RefineOptions refine_options(const LevelFlags& flags, const Progress& progress) {
  RefineOptions options;
  options.levels.criterion = flags.criterion;
  options.levels.max_level = flags.max_level;
  options.levels.wedge.rule = flags.wedge_rule;
  options.levels.wedge.angle_rad = static_cast<float>(flags.wedge_deg * kRadians);
  options.levels.pixels = static_cast<float>(flags.pixels);
  options.levels.near_distance = static_cast<float>(flags.near_distance);
  options.levels.far_distance = static_cast<float>(flags.far_distance);
  options.blend = flags.blend;
  options.center = flags.center;
  options.family = flags.family;
  options.crease_angle_rad = static_cast<float>(flags.crease_deg * kRadians);
  options.recompute_normals = flags.compute_normals;
  options.progress = progress;
  return options;
}

std::string_view criterion_name(Criterion criterion) {
  switch (criterion) {
    case Criterion::kSilhouette:
      return "silhouette";
    case Criterion::kDistance:
      return "distance";
    case Criterion::kCurvature:
      return "curvature";
    case Criterion::kUniform:
      return "uniform";
    case Criterion::kTags:
      return "tags";
  }
  return "";
}

}  // namespace limn::cli
