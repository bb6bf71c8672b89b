#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "limn/base/result.h"
#include "limn/gl/objects.h"
#include "limn/refine/patterns/table.h"

namespace limn {

/// How a pattern is drawn: the twin of PatternDraw in shaders/refine_offsets.comp.glsl.
struct PatternDraw {
  std::uint32_t index_count = 0;      ///< of all faces of an instance
  std::uint32_t first_index[2] = {};  ///< as stored, mirrored
  std::uint32_t base_vertex = 0;
  std::uint32_t faces_an_instance = 1;
  std::uint32_t triangles = 0;  ///< of one face
};

/// All patterns of a family in the device's memory, indexed with a byte where that is enough for every one. Small
/// patterns are stored four times side by side, for four faces an instance, since an instance costs as much as a few
/// vertices.
class PatternBuffers {
 public:
  /// Needs a current context. Errors: kNoGraphics when the device cannot hold them.
  static Result<PatternBuffers> create(const PatternTable& table);

  const std::vector<PatternDraw>& draws() const { return draws_; }
  const gl::Buffer& vertices() const { return vertices_; }  ///< a uint each (refine_pattern.vert.glsl)
  const gl::Buffer& indices() const { return indices_; }
  const gl::Buffer& draw_buffer() const { return draw_buffer_; }
  unsigned index_type() const { return index_type_; }  ///< a GLenum
  std::size_t bytes() const { return bytes_; }

 private:
  std::vector<PatternDraw> draws_;
  gl::Buffer vertices_, indices_, draw_buffer_;
  unsigned index_type_ = 0;
  std::size_t bytes_ = 0;
};

}  // namespace limn
