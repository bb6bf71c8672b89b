#include "limn/render/clip/clip_picture.h"

#include <algorithm>
#include <chrono>
#include <glm/geometric.hpp>
#include <new>
#include <numeric>

#include "limn/gl/timer.h"
#include "limn/render/picture.h"

namespace limn {
namespace {

Result<void> check_clip(const RenderOptions& options, const ClipDrawOptions& clip) {
  if (auto checked = check_picture(options); !checked) return checked;
  if (clip.antialias != ClipAntialias::kLines) return {};
  if (options.samples != 1)
    return fail(ErrorCode::kInvalidArgument, "outlines smoothed by lines in a picture of several samples", "use 1");
  if (options.background.w < 1.0f) {
    return fail(ErrorCode::kInvalidArgument, "outlines smoothed by lines on a background that is not opaque",
                "use samples, or an opaque background");
  }
  if (!(clip.line_width_px > 0.0f)) return fail(ErrorCode::kInvalidArgument, "a line width that is not above 0");
  return {};
}

/// How far each is, and the farthest first.
std::vector<std::size_t> farthest_first(std::span<const ClipInstance> instances, const Camera& camera) {
  std::vector<std::size_t> order(instances.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const Vec3 forward = glm::normalize(camera.target - camera.eye);
  const auto depth = [&](std::size_t i) {
    const Vec3 middle = Vec3(instances[i].to_world * Vec4(instances[i].model->bounds().center(), 1.0f));
    return glm::dot(middle - camera.eye, forward);
  };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return depth(a) > depth(b); });
  return order;
}

}  // namespace

Result<ClipPicture> render_clipped(gl::Context& context, std::span<const ClipInstance> instances, const Camera& camera,
                                   const RenderOptions& options, const ClipDrawOptions& clip) try {
  if (auto checked = check_clip(options, clip); !checked) return tl::unexpected(checked.error());
  context.make_current();
  const auto targets =
      RenderTargets::create(options.width, options.height, options.samples, RenderTargets::Stencil::kEightBits);
  if (!targets) return tl::unexpected(targets.error());
  auto frame = ClipFrame::create(context);
  if (!frame) return tl::unexpected(frame.error());
  const double scale = instances.empty() ? 1.0 : instances.front().model->unit_scale();
  const Camera seen = scaled(camera, scale);
  ClipPicture picture;
  picture.drawn.resize(instances.size());
  gl::finish();
  const auto begun = std::chrono::steady_clock::now();
  ClipDrawOptions drawing = clip;
  drawing.background = Vec3(options.background);
  frame->begin(*targets, seen, drawing);
  for (const std::size_t i : farthest_first(instances, seen)) {
    auto drawn = frame->draw(*instances[i].model, instances[i].to_world);
    if (!drawn) return tl::unexpected(drawn.error());
    picture.drawn[i] = *drawn;
  }
  frame->end();
  gl::finish();
  picture.draw_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begun).count();
  auto image = targets->resolve(context, options.background);
  if (!image) return tl::unexpected(image.error());
  picture.image = std::move(*image);
  return picture;
} catch (const std::bad_alloc&) {
  return fail(ErrorCode::kNoGraphics, "not enough memory for the picture or the silhouettes", "draw a smaller one");
}

}  // namespace limn
