#pragma once

#include <cstddef>

#include "limn/gl/objects.h"

namespace limn::gl {

/// What shaders that include compute.glsl run in: workgroups of 256, at most 1024 in a row, so that neither count of a
/// dispatch reaches the 65,535 that OpenGL promises before 2^26 workgroups do.
inline constexpr std::size_t kWorkgroupSize = 256;
inline constexpr std::size_t kWorkgroupsARow = 1024;

/// Runs the program in use in at least `groups` workgroups (the last row is filled up); none for 0.
/// \pre groups <= 1024 * 65,535
void dispatch(std::size_t groups);

/// The same with one invocation an item.
void dispatch_items(std::size_t items);

/// With the counts of workgroups that a shader wrote into a buffer.
void dispatch_indirect(unsigned command, std::size_t offset_bytes);

/// `layout(std430, binding = INDEX) buffer`
void bind_storage(unsigned index, unsigned buffer);
/// `layout(binding = UNIT) uniform sampler…`
void bind_texture(unsigned unit, const Texture& texture);
/// One level of a texture of GL_R32UI, `layout(binding = UNIT, r32ui) uniform uimage2D`.
void bind_level_to_read(unsigned unit, const Texture& texture, int level);
void bind_level_to_write(unsigned unit, const Texture& texture, int level);

/// What the next passes may do with what earlier ones wrote.
void storage_barrier();  ///< read it as storage, or take a dispatch's counts from it
void image_barrier();    ///< read it as an image or fetch it from a texture
void full_barrier();     ///< anything: draw from it, copy it, read it back

/// The most bytes one storage buffer may show, the most texels of a buffer texture, the longest side of a texture.
struct Limits {
  std::size_t storage_bytes, buffer_texels, texture_side;
};
Limits limits();

}  // namespace limn::gl
