#include "refinement_methods.h"

#include "limn/render/refinement/hardware_tessellation.h"
#include "limn/render/refinement/patterns.h"
#include "limn/render/refinement/published/ark.h"
#include "limn/render/refinement/published/arkfpi.h"
#include "limn/render/refinement/published/dmr.h"
#include "limn/render/refinement/published/dyken.h"
#include "limn/render/refinement/published/suapt.h"
#include "limn/render/refinement/published/uniform_patterns.h"
#include "limn/render/refinement/static_mesh.h"

namespace limn::cli {
namespace {

template <class Method>
Result<std::unique_ptr<RefinementMethod>> owned(Result<Method>&& made) {
  if (!made) return tl::unexpected(made.error());
  return std::make_unique<Method>(std::move(*made));
}

PatternMethodOptions pattern_options(const RefineOptions& options, std::uint64_t budget) {
  PatternMethodOptions result;
  result.levels = options.levels;
  result.family = options.family;
  result.blend = options.blend;
  result.triangle_budget = budget;
  return result;
}

DykenOptions dyken_options(const RefineOptions& options) {
  DykenOptions result;
  result.levels = options.levels;
  result.basis = options.center == CenterRule::kMean ? DykenBasis::kNine : DykenBasis::kTen;
  return result;
}

}  // namespace

std::span<const std::pair<std::string_view, RenderMethod>> render_methods() {
  static constexpr std::pair<std::string_view, RenderMethod> kMethods[] = {
      {"coarse", RenderMethod::kCoarse},
      {"refine", RenderMethod::kRefine},
      {"auto", RenderMethod::kAuto},
      {"clip", RenderMethod::kClip},
      {"patterns", RenderMethod::kPatterns},
      {"tess", RenderMethod::kTess},
      {"dyken", RenderMethod::kDyken},
      {"arkfpi", RenderMethod::kArkfpi},
      {"ark", RenderMethod::kArk},
      {"dmr", RenderMethod::kDmr},
      {"suapt", RenderMethod::kSuapt},
      {"uniform-patterns", RenderMethod::kUniformPatterns},
      {"uniform-static", RenderMethod::kUniformStatic},
  };
  return kMethods;
}

std::string_view method_name(RenderMethod method) {
  for (const auto& [name, value] : render_methods()) {
    if (value == method) return name;
  }
  return "";
}

bool on_device(RenderMethod method) {
  return method != RenderMethod::kCoarse && method != RenderMethod::kRefine && method != RenderMethod::kClip;
}

Result<std::unique_ptr<RefinementMethod>> make_method(RenderMethod method, RefinementScene& scene,
                                                      const RefineOptions& options, std::uint64_t budget) {
  switch (method) {
    case RenderMethod::kTess:
      return owned(HardwareTessellationMethod::create(scene, {.levels = options.levels}));
    case RenderMethod::kDyken:
      return owned(DykenMethod::create(scene, dyken_options(options)));
    case RenderMethod::kArkfpi:
      return owned(ArkfpiMethod::create(scene, options.levels));
    case RenderMethod::kArk:
      return owned(ArkMethod::create(scene, options.levels));
    case RenderMethod::kDmr:
      return owned(DmrMethod::create(scene, {.levels = options.levels}));
    case RenderMethod::kSuapt:
      return owned(SuaptMethod::create(scene, options.levels));
    case RenderMethod::kUniformPatterns:
      return owned(UniformPatternsMethod::create(scene, options.levels.max_level));
    case RenderMethod::kUniformStatic:
      return owned(StaticMeshMethod::uniform(scene, options.levels.max_level));
    default:
      return owned(PatternMethod::create(scene, pattern_options(options, budget)));
  }
}

}  // namespace limn::cli
