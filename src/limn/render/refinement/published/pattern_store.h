#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "limn/base/result.h"
#include "limn/gl/objects.h"
#include "limn/refine/patterns/table.h"

namespace limn {

/// All patterns of a table on the device, the unrefined triangle too, one face an instance: what the published methods
/// draw from. Indexed with a byte where that is enough for every one.
class PatternStore {
 public:
  /// Needs a current context. Errors: kNoGraphics when the device cannot hold them.
  static Result<PatternStore> create(const PatternTable& table);

  std::size_t size() const { return ranges_.size(); }
  std::uint32_t triangles(std::size_t pattern) const { return ranges_[pattern].triangle_count; }
  std::size_t bytes() const { return bytes_; }

  /// Feeds the vertices, a uint each, to attribute 0 and draws by the indices; further attributes are the caller's.
  gl::VertexArray vertex_array() const;

  /// Draws a pattern with the vertex array and program in use.
  void draw(std::size_t pattern) const;
  /// So many instances of it. \pre the table has mirrored triangles when they are asked for
  void draw_instances(std::size_t pattern, bool mirrored, std::uint32_t first, std::uint32_t count) const;

 private:
  const void* index_offset(std::size_t pattern, bool mirrored) const;
  std::vector<PatternRange> ranges_;
  gl::Buffer vertices_, indices_;
  std::size_t mirrored_triangles_ = 0;  // where they begin
  std::size_t index_bytes_ = 0, bytes_ = 0;
};

}  // namespace limn
