#include "limn/gl/compute.h"

#include <algorithm>
#include <cassert>
#include <epoxy/gl.h>

namespace limn::gl {

void dispatch(std::size_t groups) {
  if (groups == 0) return;
  const std::size_t across = std::min(groups, kWorkgroupsARow);
  const std::size_t rows = (groups + across - 1) / across;
  assert(rows <= 65535);
  glDispatchCompute(static_cast<GLuint>(across), static_cast<GLuint>(rows), 1);
}

void dispatch_items(std::size_t items) {
  dispatch((items + kWorkgroupSize - 1) / kWorkgroupSize);
}

void dispatch_indirect(unsigned command, std::size_t offset_bytes) {
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, command);
  glDispatchComputeIndirect(static_cast<GLintptr>(offset_bytes));
}

void bind_storage(unsigned index, unsigned buffer) {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, index, buffer);
}

void bind_texture(unsigned unit, const Texture& texture) {
  glBindTextureUnit(unit, texture.id());
}

void bind_level_to_read(unsigned unit, const Texture& texture, int level) {
  glBindImageTexture(unit, texture.id(), level, GL_FALSE, 0, GL_READ_ONLY, GL_R32UI);
}

void bind_level_to_write(unsigned unit, const Texture& texture, int level) {
  glBindImageTexture(unit, texture.id(), level, GL_FALSE, 0, GL_WRITE_ONLY, GL_R32UI);
}

void storage_barrier() {
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
}

void image_barrier() {
  glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
}

void full_barrier() {
  glMemoryBarrier(GL_ALL_BARRIER_BITS);
}

Limits limits() {
  const auto limit = [](GLenum name) {
    GLint64 value = 0;
    glGetInteger64v(name, &value);
    return static_cast<std::size_t>(std::max<GLint64>(value, 0));
  };
  return {limit(GL_MAX_SHADER_STORAGE_BLOCK_SIZE), limit(GL_MAX_TEXTURE_BUFFER_SIZE), limit(GL_MAX_TEXTURE_SIZE)};
}

}  // namespace limn::gl
