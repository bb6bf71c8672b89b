#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

namespace limn::gl {

/// A GL object's name and its owner: moves, does not copy, deletes with `Delete`. 0 is no object.
template <void (*Delete)(unsigned)>
class Handle {
 public:
  Handle() = default;
  explicit Handle(unsigned id) : id_(id) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  ~Handle() {
    if (id_ != 0) Delete(id_);
  }
  unsigned id() const { return id_; }
  explicit operator bool() const { return id_ != 0; }

 private:
  unsigned id_ = 0;
};

void delete_buffer(unsigned id);
void delete_texture(unsigned id);
void delete_framebuffer(unsigned id);
void delete_vertex_array(unsigned id);

using Buffer = Handle<delete_buffer>;
using Texture = Handle<delete_texture>;
using Framebuffer = Handle<delete_framebuffer>;
using VertexArray = Handle<delete_vertex_array>;

/// Each of these needs a current context (context.h).

/// A buffer that holds these bytes and is never written again; no buffer for no bytes.
Buffer make_buffer(std::span<const std::byte> bytes);

template <class T>
Buffer make_buffer_of(std::span<const T> values) {
  return make_buffer(std::as_bytes(values));
}

/// A buffer that shaders write: zeros, at least 16 bytes.
Buffer make_storage(std::size_t bytes);

/// Makes it zeros again.
void clear_storage(const Buffer& buffer);

/// Overwrites the start of a buffer that make_storage made. \pre it is large enough
void write_storage(const Buffer& buffer, std::span<const std::byte> bytes);

/// Copies from a buffer, waiting for the device to finish with it.
void read_buffer(unsigned buffer, std::size_t offset_bytes, std::span<std::byte> bytes);

/// Shows a buffer to shaders as texels of 1 to 4 uints (usamplerBuffer); the buffer must outlive it.
Texture make_uint_texture(const Buffer& buffer, std::size_t uints_a_texel);

Framebuffer make_framebuffer();
VertexArray make_vertex_array();

/// A texture without content. \param samples  1 or more; more than 1 is a multisample texture, read with texelFetch
/// \param format  a sized internal format  \param levels  1, or as many as the mip levels wanted
Texture make_texture_2d(unsigned format, int width, int height, int samples = 1, int levels = 1);

/// An array of two-dimensional textures of one size, without content.
struct ArraySize {
  int width, height, layers;
};
Texture make_texture_array(unsigned format, const ArraySize& size, int levels);

/// Feeds `components` floats a vertex (or an instance) from a buffer to an attribute.
struct FloatAttribute {
  unsigned location;
  int components;
  std::size_t offset_bytes = 0;
  std::size_t stride_bytes = 0;
  bool per_instance = false;
};
void attach_attribute(const VertexArray& array, const Buffer& buffer, const FloatAttribute& attribute);

/// Feeds `components` uints a vertex (or an instance, from the draw's base instance on) to an attribute, one after the
/// other in the buffer.
struct UintAttribute {
  unsigned location;
  int components = 1;
  bool per_instance = false;
};
void attach_uints(const VertexArray& array, const Buffer& buffer, const UintAttribute& attribute);

/// Feeds one uint an instance (from the draw's base instance on) to an attribute.
void attach_uint_per_instance(const VertexArray& array, const Buffer& buffer, unsigned location);

/// As glMultiDrawElementsIndirect reads it.
struct DrawElementsCommand {
  std::uint32_t index_count = 0;
  std::uint32_t instance_count = 1;
  std::uint32_t first_index = 0;
  std::int32_t base_vertex = 0;
  std::uint32_t base_instance = 0;
};

/// Whether the device ran out of memory since errors were last asked for; takes back every pending error.
bool take_out_of_memory();

}  // namespace limn::gl
