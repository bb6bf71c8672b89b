#include "limn/render/picture.h"

#include <cmath>
#include <epoxy/gl.h>
#include <glm/geometric.hpp>
#include <string>
#include <type_traits>

#include "limn/gl/objects.h"

namespace limn {
namespace {

constexpr int kLargestSide = 16384;

static_assert(sizeof(Segment3) == 9 * sizeof(float) && std::is_standard_layout_v<Segment3>,
              "segments are uploaded as they lie in memory");

}  // namespace

Result<void> check_picture(const RenderOptions& options) {
  const auto outside = [](int side) { return side < 1 || side > kLargestSide; };
  if (outside(options.width) || outside(options.height)) {
    return fail(ErrorCode::kInvalidArgument,
                "a picture of " + std::to_string(options.width) + " x " + std::to_string(options.height) + " pixels",
                "sides go from 1 to " + std::to_string(kLargestSide));
  }
  if (options.samples != 1 && options.samples != 4) {
    return fail(ErrorCode::kInvalidArgument, std::to_string(options.samples) + " samples a pixel", "ask for 1 or 4");
  }
  if (!(options.line_width_px > 0.0f) || !std::isfinite(options.line_width_px)) {
    return fail(ErrorCode::kInvalidArgument, "a line width that is not above 0");
  }
  for (int c = 0; c < 4; ++c) {
    if (!(options.background[c] >= 0.0f && options.background[c] <= 1.0f)) {
      return fail(ErrorCode::kInvalidArgument, "a background colour outside 0 to 1");
    }
  }
  return {};
}

double unit_scale(const Mesh& mesh, const Camera& camera) {
  const double diagonal = face_bounds(mesh).diagonal();
  const double size = diagonal > 0.0 ? diagonal : glm::length(DVec3(camera.target) - DVec3(camera.eye));
  return unit_scale(size);
}

double unit_scale(double size) {
  return size > 1e-3 && size < 1e3 ? 1.0 : std::ldexp(1.0, -std::ilogb(size));
}

Vec3 scaled(const Vec3& point, double factor) {
  return Vec3(DVec3(point) * factor);
}

Camera scaled(const Camera& camera, double factor) {
  const auto length = [factor](float value) { return static_cast<float>(double{value} * factor); };
  Camera result = camera;
  result.eye = scaled(camera.eye, factor);
  result.target = scaled(camera.target, factor);
  result.ortho_height = length(camera.ortho_height);
  result.near_distance = length(camera.near_distance);
  result.far_distance = length(camera.far_distance);
  return result;
}

Result<void> draw_segments(gl::Context& context, std::span<const Segment3> segments, const RenderOptions& options,
                           const RenderTargets& targets) {
  const std::string multisample = "MULTISAMPLE " + std::to_string(targets.samples() > 1 ? targets.samples() : 0);
  const auto found = context.program({"line.vert.glsl", "", "line.frag.glsl", {multisample}});
  if (!found) return tl::unexpected(found.error());
  const gl::Program& program = **found;
  gl::take_out_of_memory();
  const gl::Buffer buffer = gl::make_buffer_of(segments);
  if (gl::take_out_of_memory()) {
    return fail(ErrorCode::kNoGraphics,
                "the graphics device has no memory for " + std::to_string(segments.size()) + " lines");
  }
  const gl::VertexArray array = gl::make_vertex_array();
  for (unsigned i = 0; i < 3; ++i) {
    gl::attach_attribute(array, buffer, {i, 3, i * sizeof(Vec3), sizeof(Segment3), true});
  }
  program.use();
  program.set("half_width_px", 0.5f * options.line_width_px);
  targets.begin_lines();
  glBindTextureUnit(0, targets.depth().id());
  glBindVertexArray(array.id());
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(segments.size()));
  glBindVertexArray(0);
  return {};
}

}  // namespace limn
