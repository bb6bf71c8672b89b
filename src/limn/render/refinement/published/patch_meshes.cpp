#include "limn/render/refinement/published/patch_meshes.h"

#include <cstdint>
#include <epoxy/gl.h>
#include <span>
#include <vector>

#include "limn/refine/grid.h"

namespace limn {
namespace {

constexpr unsigned kVertex = 0;

/// Indices before those of P_m: 3 (4^0 + … + 4^(m-1)).
std::size_t first_index(int m) {
  return (std::size_t{1} << (2 * m)) - 1;
}

/// Vertices before those of P_m.
std::size_t first_vertex(int m) {
  std::size_t first = 0;
  for (int level = 0; level < m; ++level) {
    const std::size_t n = std::size_t{1} << level;
    first += (n + 1) * (n + 2) / 2;
  }
  return first;
}

}  // namespace

Result<PatchMeshes> PatchMeshes::create(int max_level) {
  std::vector<std::uint32_t> vertices;
  std::vector<std::uint16_t> indices;
  for (int m = 0; m <= max_level; ++m) {
    const Grid grid = make_grid(m);
    for (const GridVertex& v : grid.vertices)
      vertices.push_back(v.j | std::uint32_t{v.k} << 10);
    for (const auto& triangle : grid.triangles) {
      for (const std::uint32_t v : triangle)
        indices.push_back(static_cast<std::uint16_t>(v));
    }
  }
  PatchMeshes meshes;
  gl::take_out_of_memory();
  meshes.vertices_ = gl::make_buffer_of(std::span<const std::uint32_t>(vertices));
  meshes.indices_ = gl::make_buffer_of(std::span<const std::uint16_t>(indices));
  meshes.array_ = gl::make_vertex_array();
  const GLuint array = meshes.array_.id();
  glVertexArrayVertexBuffer(array, kVertex, meshes.vertices_.id(), 0, sizeof(std::uint32_t));
  glVertexArrayAttribIFormat(array, kVertex, 1, GL_UNSIGNED_INT, 0);
  glVertexArrayAttribBinding(array, kVertex, kVertex);
  glEnableVertexArrayAttrib(array, kVertex);
  glVertexArrayElementBuffer(array, meshes.indices_.id());
  meshes.bytes_ = vertices.size() * sizeof(std::uint32_t) + indices.size() * sizeof(std::uint16_t);
  if (gl::take_out_of_memory()) {
    return fail(ErrorCode::kNoGraphics, "the graphics device has no memory for the patches", "lower the maximal level");
  }
  return meshes;
}

void PatchMeshes::bind() const {
  glBindVertexArray(array_.id());
}

void PatchMeshes::draw(int m) const {
  glDrawElementsBaseVertex(GL_TRIANGLES, GLsizei{3} << (2 * m), GL_UNSIGNED_SHORT,
                           reinterpret_cast<const void*>(first_index(m) * sizeof(std::uint16_t)),
                           static_cast<GLint>(first_vertex(m)));
}

}  // namespace limn
