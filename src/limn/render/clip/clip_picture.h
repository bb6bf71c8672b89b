#pragma once

#include <span>
#include <vector>

#include "limn/render/clip/clip_frame.h"
#include "limn/render/render.h"

namespace limn {

/// A clipped model somewhere in the world.
struct ClipInstance {
  ClipModel* model = nullptr;
  Mat4 to_world{1.0f};  ///< turns, moves, scales alike in all directions; \pre the identity where unit_scale() is not 1
};

/// A picture and how its models were drawn, in the order given.
struct ClipPicture {
  Image image;
  std::vector<ClipDrawn> drawn;
  double draw_ms = 0;  ///< until the device was done; the first use of programs included
};

/// Draws clipped models with the lights and the meaning of pixels of render(), farthest first.
///
/// Of `options` width, height, samples and background are looked at. With antialias kLines the background must be
/// opaque, and samples 1. Leaves the context current and its GL state changed.
/// \pre camera.eye != camera.target. Errors: kInvalidArgument as render(), and for the combinations above;
/// kNoGraphics.
Result<ClipPicture> render_clipped(gl::Context& context, std::span<const ClipInstance> instances, const Camera& camera,
                                   const RenderOptions& options = {}, const ClipDrawOptions& clip = {});

}  // namespace limn
