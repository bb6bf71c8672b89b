#include "limn/render/refinement/published/uniform_patterns.h"

#include <string>
#include <utility>
#include <vector>

#include "limn/refine/levels.h"
#include "limn/render/refinement/published/per_triangle.h"
#include "limn/render/refinement/published/side_patterns.h"

namespace limn {

struct UniformPatternsMethod::Impl {
  RefinementScene* scene;
  PerTriangleDraws draws;
  std::vector<std::uint32_t> chosen;  // the one pattern, 0, for all faces but degenerate ones

  ~Impl() { scene->context().make_current(); }  // what the members delete is this context's
};

Result<UniformPatternsMethod> UniformPatternsMethod::create(RefinementScene& scene, int level) {
  if (level < 0 || level > kMaxLevel) {
    return fail(ErrorCode::kInvalidArgument, "uniform patterns of level " + std::to_string(level),
                "levels go from 0 to " + std::to_string(kMaxLevel));
  }
  scene.context().make_current();
  const auto halvings = static_cast<std::uint8_t>(level);
  const PatternSides sides{halvings, halvings, halvings};
  auto draws = PerTriangleDraws::create(scene, patterns_of_sides({&sides, 1}));
  if (!draws) return tl::unexpected(draws.error());
  const Topology& topology = scene.object_of(0).topology();
  std::vector<std::uint32_t> chosen(topology.face_count(), 0);
  for (const FaceId f : topology.degenerate_faces)
    chosen[f] = PerTriangleDraws::kNotDrawn;
  return UniformPatternsMethod(std::unique_ptr<Impl>(new Impl{&scene, std::move(*draws), std::move(chosen)}));
}

UniformPatternsMethod::UniformPatternsMethod(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
UniformPatternsMethod::~UniformPatternsMethod() = default;
UniformPatternsMethod::UniformPatternsMethod(UniformPatternsMethod&&) noexcept = default;
UniformPatternsMethod& UniformPatternsMethod::operator=(UniformPatternsMethod&&) noexcept = default;

Result<void> UniformPatternsMethod::refine(const View& view) {
  impl_->scene->context().make_current();
  impl_->scene->set_view(view);
  return {};
}

Result<void> UniformPatternsMethod::draw(const SurfacePass& pass) {
  return impl_->draws.draw(pass, impl_->chosen);
}

std::uint64_t UniformPatternsMethod::triangle_count() const {
  return impl_->draws.triangle_count(impl_->chosen);
}

std::size_t UniformPatternsMethod::device_bytes() const {
  return impl_->draws.patterns().bytes();
}

}  // namespace limn
