#include "refinement_methods.h"

#include "limn/render/refinement/hardware_tessellation.h"
#include "limn/render/refinement/patterns.h"
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

}  // namespace

std::span<const std::pair<std::string_view, RenderMethod>> render_methods() {
  static constexpr std::pair<std::string_view, RenderMethod> kMethods[] = {
      {"coarse", RenderMethod::kCoarse}, {"refine", RenderMethod::kRefine},
      {"auto", RenderMethod::kAuto},     {"patterns", RenderMethod::kPatterns},
      {"tess", RenderMethod::kTess},     {"uniform-static", RenderMethod::kUniformStatic},
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
  return method != RenderMethod::kCoarse && method != RenderMethod::kRefine;
}

Result<std::unique_ptr<RefinementMethod>> make_method(RenderMethod method, RefinementScene& scene,
                                                      const RefineOptions& options, std::uint64_t budget) {
  switch (method) {
    case RenderMethod::kTess:
      return owned(HardwareTessellationMethod::create(scene, {.levels = options.levels}));
    case RenderMethod::kUniformStatic:
      return owned(StaticMeshMethod::uniform(scene, options.levels.max_level));
    default:
      return owned(PatternMethod::create(scene, pattern_options(options, budget)));
  }
}

}  // namespace limn::cli
