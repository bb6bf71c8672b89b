#include "limn/render/refinement/pattern_buffers.h"

#include <algorithm>
#include <epoxy/gl.h>
#include <span>
#include <utility>

namespace limn {
namespace {

constexpr std::uint32_t kFacesAnInstance = 4;
/// Patterns of up to so many vertices are drawn four at a time (docs/gpu-refinement.md has the measurement).
constexpr std::uint32_t kSmallPattern = 8;

struct Flat {
  std::vector<std::uint32_t> vertices;
  std::vector<std::uint16_t> indices;
};

std::uint32_t append_indices(Flat& flat, std::span<const PatternTriangle> triangles, std::uint32_t vertex_count,
                             std::uint32_t copies) {
  const auto first = static_cast<std::uint32_t>(flat.indices.size());
  for (std::uint32_t copy = 0; copy < copies; ++copy) {
    for (const PatternTriangle& triangle : triangles) {
      for (const std::uint16_t v : triangle)
        flat.indices.push_back(static_cast<std::uint16_t>(v + copy * vertex_count));
    }
  }
  return first;
}

PatternDraw append(Flat& flat, const PatternTable& table, const PatternRange& range) {
  PatternDraw draw;
  draw.faces_an_instance = range.vertex_count <= kSmallPattern ? kFacesAnInstance : 1;
  draw.triangles = range.triangle_count;
  draw.index_count = 3 * range.triangle_count * draw.faces_an_instance;
  draw.base_vertex = static_cast<std::uint32_t>(flat.vertices.size());
  for (std::uint32_t copy = 0; copy < draw.faces_an_instance; ++copy) {
    for (std::uint32_t v = 0; v < range.vertex_count; ++v)
      flat.vertices.push_back(table.vertices[range.first_vertex + v] | copy << 24);
  }
  const auto part = [&range](const std::vector<PatternTriangle>& all) {
    return std::span(all).subspan(range.first_triangle, range.triangle_count);
  };
  draw.first_index[0] = append_indices(flat, part(table.triangles), range.vertex_count, draw.faces_an_instance);
  draw.first_index[1] = append_indices(flat, part(table.mirrored), range.vertex_count, draw.faces_an_instance);
  return draw;
}

}  // namespace

Result<PatternBuffers> PatternBuffers::create(const PatternTable& table) {
  PatternBuffers buffers;
  Flat flat;
  // Base 0 is the unrefined triangle, which is not drawn as a pattern.
  buffers.draws_.push_back({3, {0, 0}, 0, 1, 1});
  for (std::size_t base = 1; base < table.ranges.size(); ++base)
    buffers.draws_.push_back(append(flat, table, table.ranges[base]));
  gl::take_out_of_memory();
  buffers.vertices_ = gl::make_buffer_of(std::span<const std::uint32_t>(flat.vertices));
  const bool bytes = std::all_of(flat.indices.begin(), flat.indices.end(), [](std::uint16_t i) { return i < 255; });
  if (bytes) {
    const std::vector<std::uint8_t> small(flat.indices.begin(), flat.indices.end());
    buffers.indices_ = gl::make_buffer_of(std::span<const std::uint8_t>(small));
  } else {
    buffers.indices_ = gl::make_buffer_of(std::span<const std::uint16_t>(flat.indices));
  }
  buffers.index_type_ = bytes ? GL_UNSIGNED_BYTE : GL_UNSIGNED_SHORT;
  buffers.draw_buffer_ = gl::make_buffer_of(std::span<const PatternDraw>(buffers.draws_));
  buffers.bytes_ = 4 * flat.vertices.size() + (bytes ? 1 : 2) * flat.indices.size();
  if (gl::take_out_of_memory()) {
    return fail(ErrorCode::kNoGraphics, "the graphics device has no memory for the patterns",
                "lower the maximal level");
  }
  return buffers;
}

}  // namespace limn
