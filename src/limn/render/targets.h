#pragma once

#include "limn/gl/context.h"
#include "limn/gl/objects.h"
#include "limn/image/image.h"

namespace limn {

/// An offscreen picture of premultiplied colours with depth; both can be read by later passes.
class RenderTargets {
 public:
  enum class Stencil { kNone, kEightBits };

  /// \pre width, height >= 1; samples 1 or 4. Errors: kNoGraphics when the device cannot hold it.
  static Result<RenderTargets> create(int width, int height, int samples, Stencil stencil = Stencil::kNone);

  /// Draw into colour and depth from now on, both cleared (colour to nothing, depth to the far plane, stencil to 0).
  void begin_faces() const;
  /// Draw into colour alone; the depth texture may be read at the same time.
  void begin_lines() const;
  /// The picture over `background` (sRGB, straight alpha), rows from the top.
  Result<Image> resolve(gl::Context& context, const Vec4& background) const;

  const gl::Texture& depth() const { return depth_; }
  int width() const { return width_; }
  int height() const { return height_; }
  int samples() const { return samples_; }
  bool has_stencil() const { return stencil_ != Stencil::kNone; }

 private:
  Stencil stencil_ = Stencil::kNone;
  int width_ = 0, height_ = 0, samples_ = 1;
  gl::Texture color_, depth_, resolved_;
  gl::Framebuffer faces_, lines_, output_;
};

}  // namespace limn
