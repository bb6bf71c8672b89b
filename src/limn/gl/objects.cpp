#include "limn/gl/objects.h"

#include <algorithm>
#include <cassert>
#include <epoxy/gl.h>

namespace limn::gl {

void delete_buffer(unsigned id) {
  glDeleteBuffers(1, &id);
}
void delete_texture(unsigned id) {
  glDeleteTextures(1, &id);
}
void delete_framebuffer(unsigned id) {
  glDeleteFramebuffers(1, &id);
}
void delete_vertex_array(unsigned id) {
  glDeleteVertexArrays(1, &id);
}

Buffer make_buffer(std::span<const std::byte> bytes) {
  if (bytes.empty()) return {};
  unsigned id = 0;
  glCreateBuffers(1, &id);
  glNamedBufferStorage(id, static_cast<GLsizeiptr>(bytes.size()), bytes.data(), 0);
  return Buffer(id);
}

Buffer make_storage(std::size_t bytes) {
  constexpr std::size_t kLeast = 16;  // a buffer of no bytes cannot be bound
  unsigned id = 0;
  glCreateBuffers(1, &id);
  glNamedBufferStorage(id, static_cast<GLsizeiptr>(std::max(bytes, kLeast)), nullptr, GL_DYNAMIC_STORAGE_BIT);
  Buffer buffer(id);
  clear_storage(buffer);
  return buffer;
}

void clear_storage(const Buffer& buffer) {
  glClearNamedBufferData(buffer.id(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
}

void write_storage(const Buffer& buffer, std::span<const std::byte> bytes) {
  if (!bytes.empty()) glNamedBufferSubData(buffer.id(), 0, static_cast<GLsizeiptr>(bytes.size()), bytes.data());
}

void read_buffer(unsigned buffer, std::size_t offset_bytes, std::span<std::byte> bytes) {
  if (bytes.empty()) return;
  glGetNamedBufferSubData(buffer, static_cast<GLintptr>(offset_bytes), static_cast<GLsizeiptr>(bytes.size()),
                          bytes.data());
}

Texture make_uint_texture(const Buffer& buffer, std::size_t uints_a_texel) {
  assert(uints_a_texel >= 1 && uints_a_texel <= 4);
  constexpr GLenum kFormats[] = {GL_R32UI, GL_RG32UI, GL_RGB32UI, GL_RGBA32UI};
  unsigned id = 0;
  glCreateTextures(GL_TEXTURE_BUFFER, 1, &id);
  glTextureBuffer(id, kFormats[uints_a_texel - 1], buffer.id());
  return Texture(id);
}

Framebuffer make_framebuffer() {
  unsigned id = 0;
  glCreateFramebuffers(1, &id);
  return Framebuffer(id);
}

VertexArray make_vertex_array() {
  unsigned id = 0;
  glCreateVertexArrays(1, &id);
  return VertexArray(id);
}

Texture make_texture_2d(unsigned format, int width, int height, int samples, int levels) {
  unsigned id = 0;
  glCreateTextures(samples > 1 ? GL_TEXTURE_2D_MULTISAMPLE : GL_TEXTURE_2D, 1, &id);
  if (samples > 1) {
    glTextureStorage2DMultisample(id, samples, format, width, height, GL_TRUE);
  } else {
    glTextureStorage2D(id, levels, format, width, height);
  }
  return Texture(id);
}

Texture make_texture_array(unsigned format, const ArraySize& size, int levels) {
  unsigned id = 0;
  glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, &id);
  glTextureStorage3D(id, levels, format, size.width, size.height, size.layers);
  return Texture(id);
}

void attach_attribute(const VertexArray& array, const Buffer& buffer, const FloatAttribute& attribute) {
  const unsigned location = attribute.location;
  const auto stride = static_cast<GLsizei>(attribute.stride_bytes);
  glVertexArrayVertexBuffer(array.id(), location, buffer.id(), static_cast<GLintptr>(attribute.offset_bytes), stride);
  glVertexArrayAttribFormat(array.id(), location, attribute.components, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribBinding(array.id(), location, location);
  glVertexArrayBindingDivisor(array.id(), location, attribute.per_instance ? 1 : 0);
  glEnableVertexArrayAttrib(array.id(), location);
}

void attach_uints(const VertexArray& array, const Buffer& buffer, const UintAttribute& attribute) {
  const unsigned location = attribute.location;
  const GLsizei stride = attribute.components * static_cast<GLsizei>(sizeof(GLuint));
  glVertexArrayVertexBuffer(array.id(), location, buffer.id(), 0, stride);
  glVertexArrayAttribIFormat(array.id(), location, attribute.components, GL_UNSIGNED_INT, 0);
  glVertexArrayAttribBinding(array.id(), location, location);
  glVertexArrayBindingDivisor(array.id(), location, attribute.per_instance ? 1 : 0);
  glEnableVertexArrayAttrib(array.id(), location);
}

void attach_uint_per_instance(const VertexArray& array, const Buffer& buffer, unsigned location) {
  attach_uints(array, buffer, {location, 1, true});
}

bool take_out_of_memory() {
  bool out_of_memory = false;
  for (GLenum code = glGetError(); code != GL_NO_ERROR; code = glGetError()) {
    if (code == GL_OUT_OF_MEMORY) out_of_memory = true;
    if (code == GL_CONTEXT_LOST) return true;  // it stays pending for ever
  }
  return out_of_memory;
}

}  // namespace limn::gl
