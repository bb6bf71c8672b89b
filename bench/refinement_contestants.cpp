#include "refinement_contestants.h"

#include <utility>

#include "limn/render/refinement/hardware_tessellation.h"
#include "limn/render/refinement/patterns.h"
#include "limn/render/refinement/published/ark.h"
#include "limn/render/refinement/published/arkfpi.h"
#include "limn/render/refinement/published/dmr.h"
#include "limn/render/refinement/published/dyken.h"
#include "limn/render/refinement/published/suapt.h"
#include "limn/render/refinement/published/uniform_patterns.h"
#include "limn/render/refinement/static_mesh.h"

namespace limn::bench {
namespace {

using Made = Result<std::unique_ptr<RefinementMethod>>;

/// \param give  hands the method levels of the caller's own, if there are any
template <class Method, class Give>
Made owned(Result<Method>&& made, const Give& give) {
  if (!made) return tl::unexpected(made.error());
  auto method = std::make_unique<Method>(std::move(*made));
  give(*method);
  return method;
}

template <class Method>
Made owned(Result<Method>&& made) {
  return owned(std::move(made), [](Method&) {});
}

}  // namespace

Result<Contestant> Line::make(const std::string& name) const {
  const bool deforming = name == "dyken dynamic";
  const auto scene = stage_->scene(deforming);
  if (!scene) return tl::unexpected(scene.error());
  RefinementScene& s = **scene;
  const auto give_levels = [this](auto& method) {
    if (!given_.empty()) method.give_levels(given_);
  };
  const auto give_pass = [this](auto& method) {
    if (!given_.empty()) method.levels().give(given_);
  };
  Made made = [&]() -> Made {
    if (name == "uniform-static") return owned(StaticMeshMethod::uniform(s, levels_.max_level));
    if (name == "uniform-patterns") return owned(UniformPatternsMethod::create(s, levels_.max_level));
    if (name == "ark") return owned(ArkMethod::create(s, levels_), give_levels);
    if (name == "arkfpi") return owned(ArkfpiMethod::create(s, levels_), give_levels);
    if (name == "dmr") return owned(DmrMethod::create(s, {.levels = levels_}), give_levels);
    if (name == "suapt") return owned(SuaptMethod::create(s, levels_), give_levels);
    if (name == "tess") return owned(HardwareTessellationMethod::create(s, {.levels = levels_}), give_pass);
    if (name.starts_with("dyken")) {
      DykenOptions options{.levels = levels_};
      if (name == "dyken unblended") options.blending = false;
      if (name == "dyken packed") options.basis = DykenBasis::kNinePacked;
      return owned(DykenMethod::create(s, options), give_pass);
    }
    PatternMethodOptions options{.levels = levels_};
    options.family = name.starts_with("patterns nested") ? PatternFamily::kNested : PatternFamily::kMinimal;
    options.store = name.ends_with("stored") || name.ends_with("held");
    options.store_attributes = !positions_only_;
    // Room for everything, so that nothing needs to be cut.
    if (options.store) options.triangle_budget = s.triangle_count() << (2 * levels_.max_level);
    return owned(PatternMethod::create(s, options), give_pass);
  }();
  if (!made) return tl::unexpected(made.error());
  return Contestant{name, std::move(*made), deforming ? *scene : nullptr, name.ends_with("held")};
}

Line& Line::add(const std::string& name) {
  if (!state_) return *this;
  auto made = make(name);
  if (made) {
    contestants_.push_back(std::move(*made));
  } else {
    state_ = tl::unexpected(made.error());
  }
  return *this;
}

Result<std::vector<FrameTimes>> Line::time(const FrameOptions& options) {
  if (!state_) return tl::unexpected(state_.error());
  return stage_->time(contestants_, options);
}

}  // namespace limn::bench
