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
  std::vector<std::uint16_t> indices, batches;
};

/// As many faces side by side as make an instance of some hundred vertices.
std::uint32_t batch_of(std::uint32_t vertex_count) {
  if (vertex_count <= 64) return kLargestBatch;
  return vertex_count <= 1024 ? 4 : 1;
}

std::uint32_t append_indices(std::vector<std::uint16_t>& indices, std::span<const PatternTriangle> triangles,
                             std::uint32_t vertex_count, std::uint32_t copies) {
  const auto first = static_cast<std::uint32_t>(indices.size());
  for (std::uint32_t copy = 0; copy < copies; ++copy) {
    for (const PatternTriangle& triangle : triangles) {
      for (const std::uint16_t v : triangle)
        indices.push_back(static_cast<std::uint16_t>(v + copy * vertex_count));
    }
  }
  return first;
}

PatternDraw append(Flat& flat, const PatternTable& table, std::uint32_t base) {
  const PatternRange& range = table.ranges[base];
  PatternDraw draw;
  draw.border = 0;
  for (unsigned c = 0; c < 3; ++c) {
    const std::uint32_t halvings = pattern_config(table.family, base).sides[c];
    draw.border += 1u << halvings;
    draw.halvings |= halvings << (4 * c);
  }
  draw.vertices = range.vertex_count;
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
  draw.batch = batch_of(range.vertex_count);
  draw.batch_index_count = 3 * range.triangle_count * draw.batch;
  for (int mirrored = 0; mirrored < 2; ++mirrored) {
    const auto triangles = part(mirrored == 0 ? table.triangles : table.mirrored);
    draw.first_index[mirrored] = append_indices(flat.indices, triangles, range.vertex_count, draw.faces_an_instance);
    draw.batch_first_index[mirrored] = append_indices(flat.batches, triangles, range.vertex_count, draw.batch);
  }
  return draw;
}

}  // namespace

Result<PatternBuffers> PatternBuffers::create(PatternTable table, bool batches) {
  PatternBuffers buffers;
  Flat flat;
  // Base 0 is the unrefined triangle, which is not drawn as a pattern.
  buffers.draws_.push_back({.index_count = 3, .triangles = 1});
  for (std::uint32_t base = 1; base < table.ranges.size(); ++base)
    buffers.draws_.push_back(append(flat, table, base));
  gl::take_out_of_memory();
  buffers.vertices_ = gl::make_buffer_of(std::span<const std::uint32_t>(flat.vertices));
  const bool bytes = std::all_of(flat.indices.begin(), flat.indices.end(), [](std::uint16_t i) { return i < 255; });
  if (batches) {
    buffers.batch_indices_ = gl::make_buffer_of(std::span<const std::uint16_t>(flat.batches));
    buffers.batch_bytes_ = 2 * flat.batches.size();
  }
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
  buffers.table_ = std::move(table);
  return buffers;
}

std::span<const PatternTriangle> PatternBuffers::triangles(std::uint32_t base, bool mirrored) const {
  const PatternRange& range = table_.ranges[base];
  return std::span(mirrored ? table_.mirrored : table_.triangles).subspan(range.first_triangle, range.triangle_count);
}

}  // namespace limn
