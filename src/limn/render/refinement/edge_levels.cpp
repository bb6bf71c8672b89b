#include "limn/render/refinement/edge_levels.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>
#include <utility>

#include "limn/gl/compute.h"
#include "limn/gl/objects.h"

namespace limn {
namespace {

/// CRITERION of refine_edges.comp.glsl.
int shader_criterion(Criterion criterion) {
  if (criterion == Criterion::kSilhouette) return 0;
  if (criterion == Criterion::kUniform) return 3;
  return criterion == Criterion::kDistance ? 1 : 2;
}

/// Lets check_levels() look at the options alone.
constexpr View kAnyView{{}, 1.0f};

/// Whether the criterion's value is a number an edge that does not depend on the eye.
bool is_stored(Criterion criterion) {
  return shader_criterion(criterion) == 2;
}

}  // namespace

struct EdgeLevelPass::Impl {
  const RefinementScene* scene = nullptr;
  LevelOptions options;
  gl::Buffer levels, shares;
  gl::Texture texture;
  const gl::Program* program = nullptr;
  std::size_t share_count = 0;
  bool given = false;

  ~Impl() {
    if (scene != nullptr) scene->context().make_current();  // what the members delete is this context's
  }
};

Result<EdgeLevelPass> EdgeLevelPass::create(const RefinementScene& scene, const LevelOptions& options) {
  auto impl = std::make_unique<Impl>();
  impl->scene = &scene;
  impl->options = options;
  scene.context().make_current();
  for (const Refiner* object : scene.objects()) {
    if (auto good = check_levels(object->mesh(), kAnyView, options); !good) return tl::unexpected(good.error());
  }
  const auto program = scene.context().compute_program(
      "refine_edges.comp.glsl", {"CRITERION " + std::to_string(shader_criterion(options.criterion))});
  if (!program) return tl::unexpected(program.error());
  impl->program = *program;
  gl::take_out_of_memory();
  if (is_stored(options.criterion)) {
    std::vector<float> all;
    for (const Refiner* object : scene.objects()) {
      const auto shares = edge_shares(object->mesh(), object->topology(), {}, kAnyView, options);
      if (!shares) return tl::unexpected(shares.error());
      all.insert(all.end(), shares->begin(), shares->end());
    }
    impl->shares = gl::make_buffer_of(std::span<const float>(all));
    impl->share_count = all.size();
  }
  impl->levels = gl::make_storage(scene.edge_capacity() * sizeof(std::uint32_t));
  impl->texture = gl::make_uint_texture(impl->levels, 1);
  if (gl::take_out_of_memory()) {
    return fail(
        ErrorCode::kNoGraphics,
        "the graphics device has no memory for the levels of " + std::to_string(scene.edge_capacity()) + " edges",
        "draw a smaller scene");
  }
  return EdgeLevelPass(std::move(impl));
}

EdgeLevelPass::EdgeLevelPass(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
EdgeLevelPass::~EdgeLevelPass() = default;
EdgeLevelPass::EdgeLevelPass(EdgeLevelPass&&) noexcept = default;
EdgeLevelPass& EdgeLevelPass::operator=(EdgeLevelPass&&) noexcept = default;

const LevelOptions& EdgeLevelPass::options() const {
  return impl_->options;
}
unsigned EdgeLevelPass::buffer() const {
  return impl_->levels.id();
}
const gl::Texture& EdgeLevelPass::texture() const {
  return impl_->texture;
}
std::size_t EdgeLevelPass::bytes() const {
  return impl_->scene->edge_capacity() * sizeof(std::uint32_t) + impl_->share_count * sizeof(float);
}

void EdgeLevelPass::run() const {
  gl::bind_storage(0, impl_->levels.id());
  if (impl_->given) return;
  const LevelOptions& options = impl_->options;
  impl_->scene->bind();
  impl_->scene->bind_edge_tables();
  gl::bind_storage(1, impl_->shares ? impl_->shares.id() : impl_->levels.id());
  const gl::Program& program = *impl_->program;
  program.use();
  program.set("max_level", static_cast<unsigned>(options.max_level));
  program.set("tolerance_px", options.pixels);
  const float sine = std::sin(options.wedge.angle_rad);
  program.set("wedge_sine_cosine", sine * std::cos(options.wedge.angle_rad));
  program.set("wedge_sine_squared", sine * sine);
  program.set("wedge_quarter", options.wedge.rule == Wedge::Rule::kQuarter ? 1 : 0);
  program.set("distances", Vec2(options.near_distance, options.far_distance));
  gl::dispatch_items(impl_->scene->edge_capacity());
  gl::storage_barrier();
}

void EdgeLevelPass::give(std::span<const float> levels) {
  std::vector<std::uint32_t> words(impl_->scene->edge_capacity(), 0);
  std::size_t next = 0;
  for (std::size_t i = 0; i < impl_->scene->instance_count(); ++i) {
    const std::size_t count = impl_->scene->object_of(i).topology().edge_count();
    assert(next + count <= levels.size());
    for (std::size_t e = 0; e < count; ++e, ++next) {
      words[impl_->scene->first_edge(i) + e] = static_cast<std::uint32_t>(quantized_level(levels[next]) / kLevelUnit);
    }
  }
  gl::write_storage(impl_->levels, std::as_bytes(std::span(words)));
  impl_->given = true;
}

std::vector<std::uint16_t> EdgeLevelPass::read(std::size_t instance) const {
  std::vector<std::uint32_t> words(impl_->scene->object_of(instance).topology().edge_count());
  gl::full_barrier();
  gl::read_buffer(impl_->levels.id(), impl_->scene->first_edge(instance) * sizeof(std::uint32_t),
                  std::as_writable_bytes(std::span(words)));
  std::vector<std::uint16_t> levels(words.size());
  for (std::size_t e = 0; e < words.size(); ++e)
    levels[e] = static_cast<std::uint16_t>(words[e] & 0xffffu);
  return levels;
}

}  // namespace limn
