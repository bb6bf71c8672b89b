#include "limn/render/refinement/hardware_tessellation.h"

#include <algorithm>
#include <cmath>
#include <epoxy/gl.h>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "limn/gl/compute.h"

namespace limn {
namespace {

constexpr unsigned kLevelsUnit = 11;  // refine_tess.vert.glsl

SurfaceProgram stages_of(TessellationSpacing spacing) {
  SurfaceProgram stages;
  stages.vertex = "refine_tess.vert.glsl";
  stages.tessellation_control = "refine_tess.tesc.glsl";
  stages.tessellation_evaluation = "refine_tess.tese.glsl";
  const bool equal = spacing == TessellationSpacing::kEqual;
  stages.defines = {equal ? "FRACTIONAL 0" : "FRACTIONAL 1", equal ? "SPACING equal_spacing"
                                                             : spacing == TessellationSpacing::kFractionalOdd
                                                                 ? "SPACING fractional_odd_spacing"
                                                                 : "SPACING fractional_even_spacing"};
  return stages;
}

/// Patches that one draw makes. Mesa's software device copies what a batch has tessellated each time it needs more
/// room, in quadratic time: 490 patches of 64 segments a side take minutes in one. It cuts batches itself for small
/// ones.
std::size_t patches_a_draw(int max_level) {
  constexpr std::size_t kVertices = 1 << 16;
  return max_level <= 3 ? std::numeric_limits<std::size_t>::max() : kVertices >> (2 * max_level);
}

/// The index of corner c of a face, counted over instances, is 3 face + c.
std::vector<std::uint32_t> all_corners(const RefinementScene& scene) {
  std::vector<std::uint32_t> corners;
  corners.reserve(3 * scene.triangle_count());
  for (std::size_t i = 0; i < scene.instance_count(); ++i) {
    const std::size_t first = 3 * scene.first_face(i);
    const std::size_t count = 3 * scene.object_of(i).topology().face_count();
    for (std::size_t corner = first; corner < first + count; ++corner)
      corners.push_back(static_cast<std::uint32_t>(corner));
  }
  return corners;
}

/// The whole number of segments that a level becomes.
std::uint64_t segment_count(TessellationSpacing spacing, float level) {
  const auto up = static_cast<std::uint64_t>(std::ceil(std::max(level, 1.0f)));
  if (spacing == TessellationSpacing::kEqual) return up;
  if (spacing == TessellationSpacing::kFractionalOdd) return up | 1u;
  return std::max<std::uint64_t>(2, up + (up & 1u));
}

float level_segments(TessellationSpacing spacing, std::uint16_t units) {
  const float level = static_cast<float>(units) * kLevelUnit;
  return std::exp2(spacing == TessellationSpacing::kEqual ? std::ceil(level) : level);
}

}  // namespace

std::uint64_t tessellator_triangles(TessellationSpacing spacing, const float (&sides)[3], float inner) {
  std::uint64_t count = 0;
  bool whole = true;
  for (const float side : sides) {
    if (!(side > 0.0f)) return 0;
    count += segment_count(spacing, side);
    whole = whole && segment_count(spacing, side) == 1;
  }
  std::uint64_t n = segment_count(spacing, inner);
  if (n == 1 && whole) return 1;
  // A finer side needs a ring to lead from it to the middle.
  if (n == 1) n = segment_count(spacing, std::nextafter(1.0f, 2.0f));
  // The outermost ring joins the sides to a triangle of n - 2 segments a side, and so on inwards.
  for (n -= 2; n > 1; n -= 2)
    count += 3 * (n + n);
  return count + (n == 1 ? 4 : 0);
}

HardwareTessellationMethod::HardwareTessellationMethod(RefinementScene& scene,
                                                       const HardwareTessellationOptions& options)
    : scene_(&scene), options_(options), programs_(stages_of(options.spacing)) {}

Result<HardwareTessellationMethod> HardwareTessellationMethod::create(RefinementScene& scene,
                                                                      const HardwareTessellationOptions& options) {
  scene.context().make_current();
  GLint most = 0;
  glGetIntegerv(GL_MAX_TESS_GEN_LEVEL, &most);
  if (options.spacing == TessellationSpacing::kFractionalOdd) --most;  // the largest odd number
  if (options.levels.max_level <= kMaxLevel && (1 << std::max(0, options.levels.max_level)) > most) {
    return fail(ErrorCode::kInvalidArgument,
                "the device's tessellation divides a side into " + std::to_string(most) + " segments at most, not 2^" +
                    std::to_string(options.levels.max_level),
                "lower the maximal level, or draw by patterns");
  }
  HardwareTessellationMethod method(scene, options);
  auto levels = EdgeLevelPass::create(scene, options.levels);
  if (!levels) return tl::unexpected(levels.error());
  method.levels_ = std::make_unique<EdgeLevelPass>(std::move(*levels));
  gl::take_out_of_memory();
  method.corners_ = gl::make_buffer_of(std::span<const std::uint32_t>(all_corners(scene)));
  method.array_ = gl::make_vertex_array();
  glVertexArrayElementBuffer(method.array_.id(), method.corners_.id());
  if (gl::take_out_of_memory()) {
    return fail(
        ErrorCode::kNoGraphics,
        "the graphics device has no memory for the patches of " + std::to_string(scene.triangle_count()) + " faces",
        "draw a smaller scene");
  }
  return method;
}

Result<void> HardwareTessellationMethod::refine(const View& view) {
  for (const Refiner* object : scene_->objects()) {
    if (auto good = check_levels(object->mesh(), view, options_.levels); !good) return tl::unexpected(good.error());
  }
  scene_->context().make_current();
  scene_->set_view(view);
  levels_->run();
  gl::image_barrier();
  return {};
}

Result<void> HardwareTessellationMethod::draw(const SurfacePass& pass) {
  scene_->bind();
  gl::bind_texture(kLevelsUnit, levels_->texture());
  const auto program = programs_.use(*scene_, pass);
  if (!program) return tl::unexpected(program.error());
  (*program)->set("mean_center", scene_->options().center == CenterRule::kMean ? 1 : 0);
  glPatchParameteri(GL_PATCH_VERTICES, 3);
  glBindVertexArray(array_.id());
  // Indexed, although the indices only count: one call of as many patches without takes llvmpipe quadratic time.
  const std::size_t all = scene_->triangle_count();
  const std::size_t share = std::max<std::size_t>(1, patches_a_draw(options_.levels.max_level));
  draw_hooked(pass, [&] {
    for (std::size_t first = 0; first < all; first += std::min(share, all - first)) {
      glDrawElements(GL_PATCHES, static_cast<GLsizei>(3 * std::min(share, all - first)), GL_UNSIGNED_INT,
                     reinterpret_cast<const void*>(3 * sizeof(std::uint32_t) * first));
    }
  });
  return {};
}

std::uint64_t HardwareTessellationMethod::triangle_count() const {
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < scene_->instance_count(); ++i) {
    const std::vector<std::uint16_t> levels = levels_->read(i);
    for (const auto& edges : scene_->object_of(i).topology().face_edges) {
      if (edges[0] == kInvalidId) continue;
      float sides[3];
      for (int c = 0; c < 3; ++c)
        sides[c] = level_segments(options_.spacing, levels[edges[static_cast<std::size_t>(c)]]);
      count += tessellator_triangles(options_.spacing, sides, *std::max_element(sides, sides + 3));
    }
  }
  return count;
}

std::size_t HardwareTessellationMethod::device_bytes() const {
  return scene_->table_bytes() + levels_->bytes() + 3 * sizeof(std::uint32_t) * scene_->triangle_count();
}

}  // namespace limn
