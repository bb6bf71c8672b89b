#include "limn/render/refinement/published/pattern_store.h"

#include <algorithm>
#include <epoxy/gl.h>
#include <span>
#include <string>

namespace limn {
namespace {

template <class Index>
gl::Buffer upload_indices(const PatternTable& table) {
  std::vector<Index> indices;
  for (const auto* triangles : {&table.triangles, &table.mirrored}) {
    for (const PatternTriangle& triangle : *triangles)
      indices.insert(indices.end(), triangle.begin(), triangle.end());
  }
  return gl::make_buffer_of(std::span<const Index>(indices));
}

GLenum index_type(std::size_t index_bytes) {
  return index_bytes == 1 ? GL_UNSIGNED_BYTE : GL_UNSIGNED_SHORT;
}

GLsizei index_count(const PatternRange& range) {
  return static_cast<GLsizei>(3 * range.triangle_count);
}

}  // namespace

Result<PatternStore> PatternStore::create(const PatternTable& table) {
  gl::take_out_of_memory();
  PatternStore store;
  store.ranges_ = table.ranges;
  store.vertices_ = gl::make_buffer_of(std::span<const std::uint32_t>(table.vertices));
  const bool bytes = std::all_of(table.ranges.begin(), table.ranges.end(), fits_byte_indices);
  store.indices_ = bytes ? upload_indices<std::uint8_t>(table) : upload_indices<std::uint16_t>(table);
  store.index_bytes_ = bytes ? 1 : 2;
  store.mirrored_triangles_ = table.triangles.size();
  store.bytes_ = 4 * table.vertices.size() + 3 * store.index_bytes_ * (table.triangles.size() + table.mirrored.size());
  if (gl::take_out_of_memory()) {
    return fail(ErrorCode::kNoGraphics,
                "the graphics device has no memory for " + std::to_string(table.ranges.size()) + " patterns",
                "lower the maximal level");
  }
  return store;
}

gl::VertexArray PatternStore::vertex_array() const {
  gl::VertexArray array = gl::make_vertex_array();
  gl::attach_uints(array, vertices_, {.location = 0});
  glVertexArrayElementBuffer(array.id(), indices_.id());
  return array;
}

const void* PatternStore::index_offset(std::size_t pattern, bool mirrored) const {
  const std::size_t triangle = ranges_[pattern].first_triangle + (mirrored ? mirrored_triangles_ : 0);
  return reinterpret_cast<const void*>(3 * triangle * index_bytes_);
}

void PatternStore::draw(std::size_t pattern) const {
  const PatternRange& range = ranges_[pattern];
  glDrawElementsBaseVertex(GL_TRIANGLES, index_count(range), index_type(index_bytes_), index_offset(pattern, false),
                           static_cast<GLint>(range.first_vertex));
}

void PatternStore::draw_instances(std::size_t pattern, bool mirrored, std::uint32_t first, std::uint32_t count) const {
  const PatternRange& range = ranges_[pattern];
  glDrawElementsInstancedBaseVertexBaseInstance(GL_TRIANGLES, index_count(range), index_type(index_bytes_),
                                                index_offset(pattern, mirrored), static_cast<GLsizei>(count),
                                                static_cast<GLint>(range.first_vertex), first);
}

}  // namespace limn
