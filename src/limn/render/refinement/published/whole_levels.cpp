#include "limn/render/refinement/published/whole_levels.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "limn/mesh/normals.h"

namespace limn {
namespace {

/// Lets check_levels() look at the options alone.
constexpr View kAnyView{{}, 1.0f};

}  // namespace

Result<WholeLevels> WholeLevels::create(const RefinementScene& scene, const LevelOptions& options) {
  assert(scene.instance_count() == 1);
  WholeLevels levels;
  levels.object_ = &scene.object_of(0);
  levels.options_ = options;
  if (auto good = check_levels(levels.object_->mesh(), kAnyView, options); !good) return tl::unexpected(good.error());
  levels.face_normals_ = face_normals(levels.object_->mesh());
  levels.edges_.assign(levels.topology().edge_count(), 0);
  return levels;
}

Result<void> WholeLevels::decide(const View& view) {
  if (given_) return {};
  const auto levels = edge_levels(object_->mesh(), topology(), face_normals_, object_->curves(), view, options_);
  if (!levels) return tl::unexpected(levels.error());
  round_up(*levels);
  return {};
}

void WholeLevels::give(std::span<const float> levels) {
  assert(levels.size() == edges_.size());
  given_ = true;
  round_up(levels);
}

void WholeLevels::round_up(std::span<const float> levels) {
  std::transform(levels.begin(), levels.end(), edges_.begin(),
                 [](float level) { return static_cast<std::uint8_t>(std::ceil(quantized_level(level))); });
}

std::array<std::uint8_t, 3> WholeLevels::sides(FaceId face) const {
  const auto& edges = topology().face_edges[face];
  return {edges_[edges[0]], edges_[edges[1]], edges_[edges[2]]};
}

}  // namespace limn
