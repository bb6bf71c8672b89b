#pragma once

#include <span>

#include "limn/base/result.h"
#include "limn/gl/context.h"
#include "limn/render/render.h"
#include "limn/render/targets.h"

namespace limn {

/// What every way to draw a picture shares.

/// Errors: kInvalidArgument, as render() says.
Result<void> check_picture(const RenderOptions& options);

/// The factor that brings a mesh near unit size: 1 where it is so already, else a power of two, which changes no digit.
/// Squares and products in a shader are floats: a model in kilometres or nanometres has to come near unit size before
/// it is drawn. A mesh of one point is as large as it is far.
double unit_scale(const Mesh& mesh, const Camera& camera);
/// The same for what is so large. \pre size > 0
double unit_scale(double size);

Vec3 scaled(const Vec3& point, double factor);
Camera scaled(const Camera& camera, double factor);

/// Draws lines into targets that hold the surfaces. \pre the camera is bound; options were checked
Result<void> draw_segments(gl::Context& context, std::span<const Segment3> segments, const RenderOptions& options,
                           const RenderTargets& targets);

}  // namespace limn
