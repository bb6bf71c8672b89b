#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "limn/base/result.h"
#include "limn/gl/objects.h"
#include "limn/refine/patterns/table.h"

namespace limn {

/// How a pattern is drawn: the twin of PatternDraw in shaders/refine_groups.glsl.
struct PatternDraw {
  std::uint32_t index_count = 0;      ///< of all faces of an instance
  std::uint32_t first_index[2] = {};  ///< as stored, mirrored
  std::uint32_t base_vertex = 0;
  std::uint32_t faces_an_instance = 1;
  std::uint32_t triangles = 0;  ///< of one face
  std::uint32_t vertices = 3;   ///< of one face
  std::uint32_t border = 3;     ///< of these, on its border; they come first
  std::uint32_t batch = 1;      ///< faces an instance where vertices are stored (stored_surface.h)
  std::uint32_t batch_index_count = 0;
  std::uint32_t batch_first_index[2] = {};
  std::uint32_t halvings = 0;  ///< of sides 0, 1, 2, four bits each
};

/// The largest PatternDraw::batch; kAlignment of shaders/refine_groups.glsl.
inline constexpr std::uint32_t kLargestBatch = 16;

/// All patterns of a family in the device's memory, indexed with a byte where that is enough for every one. Small
/// patterns are stored four times side by side, for four faces an instance, since an instance costs as much as a few
/// vertices.
class PatternBuffers {
 public:
  /// Needs a current context. Errors: kNoGraphics when the device cannot hold them.
  /// \param batches  batch_indices() too
  static Result<PatternBuffers> create(PatternTable table, bool batches = false);

  const std::vector<PatternDraw>& draws() const { return draws_; }
  const gl::Buffer& vertices() const { return vertices_; }  ///< a uint each (refine_pattern.vert.glsl)
  const gl::Buffer& indices() const { return indices_; }
  const gl::Buffer& draw_buffer() const { return draw_buffer_; }
  unsigned index_type() const { return index_type_; }  ///< a GLenum
  std::size_t bytes() const { return bytes_; }

  /// One face's triangles, for reading back.
  std::span<const PatternTriangle> triangles(std::uint32_t base, bool mirrored) const;

  /// 16-bit indices of PatternDraw::batch faces of each pattern side by side; and what they take.
  const gl::Buffer& batch_indices() const { return batch_indices_; }
  std::size_t batch_bytes() const { return batch_bytes_; }

 private:
  PatternTable table_;
  std::vector<PatternDraw> draws_;
  gl::Buffer vertices_, indices_, draw_buffer_, batch_indices_;
  unsigned index_type_ = 0;
  std::size_t bytes_ = 0, batch_bytes_ = 0;
};

}  // namespace limn
