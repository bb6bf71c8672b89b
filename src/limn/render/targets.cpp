#include "limn/render/targets.h"

#include <algorithm>
#include <epoxy/gl.h>
#include <string>

namespace limn {
namespace {

bool complete(const gl::Framebuffer& framebuffer) {
  return glCheckNamedFramebufferStatus(framebuffer.id(), GL_DRAW_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
}

tl::unexpected<Error> too_large(int width, int height, int samples) {
  return fail(ErrorCode::kNoGraphics,
              "the graphics device cannot hold a picture of " + std::to_string(width) + " x " + std::to_string(height) +
                  " pixels with " + std::to_string(samples) + (samples == 1 ? " sample" : " samples"),
              samples > 1 ? "ask for a smaller picture, or for 1 sample" : "ask for a smaller picture");
}

int limit_of(GLenum name) {
  GLint value = 0;
  glGetIntegerv(name, &value);
  return value;
}

}  // namespace

Result<RenderTargets> RenderTargets::create(int width, int height, int samples, Stencil stencil) {
  const int largest = std::min(limit_of(GL_MAX_TEXTURE_SIZE), limit_of(GL_MAX_RENDERBUFFER_SIZE));
  if (width > largest || height > largest) return too_large(width, height, samples);
  gl::take_out_of_memory();
  RenderTargets targets;
  targets.width_ = width;
  targets.height_ = height;
  targets.samples_ = samples;
  targets.stencil_ = stencil;
  const bool has_stencil = stencil != Stencil::kNone;
  targets.color_ = gl::make_texture_2d(GL_SRGB8_ALPHA8, width, height, samples);
  targets.depth_ =
      gl::make_texture_2d(has_stencil ? GL_DEPTH32F_STENCIL8 : GL_DEPTH_COMPONENT32F, width, height, samples);
  targets.resolved_ = gl::make_texture_2d(GL_RGBA8, width, height);
  if (gl::take_out_of_memory()) return too_large(width, height, samples);
  targets.faces_ = gl::make_framebuffer();
  targets.lines_ = gl::make_framebuffer();
  targets.output_ = gl::make_framebuffer();
  glNamedFramebufferTexture(targets.faces_.id(), GL_COLOR_ATTACHMENT0, targets.color_.id(), 0);
  glNamedFramebufferTexture(targets.faces_.id(), has_stencil ? GL_DEPTH_STENCIL_ATTACHMENT : GL_DEPTH_ATTACHMENT,
                            targets.depth_.id(), 0);
  glNamedFramebufferTexture(targets.lines_.id(), GL_COLOR_ATTACHMENT0, targets.color_.id(), 0);
  glNamedFramebufferTexture(targets.output_.id(), GL_COLOR_ATTACHMENT0, targets.resolved_.id(), 0);
  if (!complete(targets.faces_) || !complete(targets.lines_) || !complete(targets.output_) ||
      gl::take_out_of_memory()) {
    return too_large(width, height, samples);
  }
  return targets;
}

void RenderTargets::begin_faces() const {
  glBindFramebuffer(GL_FRAMEBUFFER, faces_.id());
  glViewport(0, 0, width_, height_);
  glEnable(GL_FRAMEBUFFER_SRGB);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glDepthMask(GL_TRUE);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDisable(GL_CULL_FACE);
  glDisable(GL_STENCIL_TEST);
  glDisable(GL_BLEND);
  const GLfloat nothing[4] = {0, 0, 0, 0};
  const GLfloat far_plane = 1.0f;
  glClearNamedFramebufferfv(faces_.id(), GL_COLOR, 0, nothing);
  if (has_stencil()) {
    glStencilMask(0xff);
    glClearNamedFramebufferfi(faces_.id(), GL_DEPTH_STENCIL, 0, far_plane, 0);
  } else {
    glClearNamedFramebufferfv(faces_.id(), GL_DEPTH, 0, &far_plane);
  }
}

void RenderTargets::begin_lines() const {
  glBindFramebuffer(GL_FRAMEBUFFER, lines_.id());
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_STENCIL_TEST);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
}

Result<Image> RenderTargets::resolve(gl::Context& context, const Vec4& background) const {
  const std::string multisample = "MULTISAMPLE " + std::to_string(samples_ > 1 ? samples_ : 0);
  const auto program = context.program({"fullscreen.vert.glsl", "", "resolve.frag.glsl", {multisample}});
  if (!program) return tl::unexpected(program.error());
  (*program)->use();
  (*program)->set("background", background);
  (*program)->set("height", height_);
  glBindTextureUnit(0, color_.id());
  glBindFramebuffer(GL_FRAMEBUFFER, output_.id());
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_STENCIL_TEST);
  glDisable(GL_BLEND);
  glDisable(GL_FRAMEBUFFER_SRGB);
  const gl::VertexArray no_attributes = gl::make_vertex_array();
  glBindVertexArray(no_attributes.id());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  Image image(width_, height_);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, image.rgba.data());
  glBindVertexArray(0);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  if (gl::take_out_of_memory()) return too_large(width_, height_, samples_);
  return image;
}

}  // namespace limn
