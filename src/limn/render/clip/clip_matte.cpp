#include "limn/render/clip/clip_matte.h"

#include <epoxy/gl.h>

namespace limn {

Result<ClipMatte> ClipMatte::create(gl::Context& context) {
  ClipMatte matte;
  const auto lines = context.program({"clip_line.vert.glsl", "", "clip_line.frag.glsl", {}});
  if (!lines) return tl::unexpected(lines.error());
  matte.lines_ = *lines;
  const auto fill = context.program({"fullscreen.vert.glsl", "", "clip_fill.frag.glsl", {}});
  if (!fill) return tl::unexpected(fill.error());
  matte.fill_ = *fill;
  matte.array_ = gl::make_vertex_array();
  matte.none_ = gl::make_vertex_array();
  for (const unsigned i : {0u, 1u}) {
    glEnableVertexArrayAttrib(matte.array_.id(), i);
    glVertexArrayAttribFormat(matte.array_.id(), i, 3, GL_FLOAT, GL_FALSE, i * static_cast<GLuint>(sizeof(Vec3)));
    glVertexArrayAttribBinding(matte.array_.id(), i, 0);
  }
  glVertexArrayBindingDivisor(matte.array_.id(), 0, 1);
  return matte;
}

void ClipMatte::draw_lines(unsigned buffer, std::size_t offset_bytes, std::size_t count, std::span<const Vec4> rows,
                           float width_px) const {
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_TRUE);
  const GLfloat nothing[4] = {0, 0, 0, 0};
  glClearBufferfv(GL_COLOR, 0, nothing);
  lines_->use();
  lines_->set("to_world_rows[0]", rows);
  lines_->set("half_width_px", 0.5f * width_px);
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_STENCIL_TEST);
  glStencilFunc(GL_ALWAYS, kLineBit, kLineBit);
  glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
  glStencilMask(kLineBit);
  // The paper replaces what is there; where segments meet the faint rim of one would then cover the core of another.
  glEnable(GL_BLEND);
  glBlendEquation(GL_MAX);
  glVertexArrayVertexBuffer(array_.id(), 0, buffer, static_cast<GLintptr>(offset_bytes), sizeof(MatteSegment));
  glBindVertexArray(array_.id());
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(count));
  glBlendEquation(GL_FUNC_ADD);
  glDisable(GL_BLEND);
}

void ClipMatte::transfer() const {
  fill_->use();
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_TRUE);
  glStencilFunc(GL_NOTEQUAL, 0, kCountBits);
  glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
  glBindVertexArray(none_.id());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void segments_of(const StencilLoops& loops, LineVector<MatteSegment>& segments) {
  segments.clear();
  std::uint32_t first = 0;
  for (const std::uint32_t end : loops.ends) {
    for (std::uint32_t i = first; i < end; ++i)
      segments.push_back({loops.points[i], loops.points[i + 1 < end ? i + 1 : first]});
    first = end;
  }
}

}  // namespace limn
