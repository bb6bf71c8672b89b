#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "limn/base/vec.h"
#include "limn/mesh/formats/gltf_document.h"
#include "limn/mesh/ids.h"

namespace limn::formats::gltf {

/// The vertices of a primitive as stored; an attribute it does not have is empty, one it has counts as many as
/// positions.
struct Vertices {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;
  std::vector<Vec2> uvs;  ///< v downwards, as in glTF
  std::vector<Vec4> colors;
};

/// Which accessors a primitive's vertices come from: primitives with the same key share their vertices.
using VertexKey = std::array<std::uint64_t, 4>;
VertexKey vertex_key(const Field& primitive);

/// What Draco stores is vertices and triangles in one.
struct Compressed {
  Vertices vertices;
  std::vector<Triangle> triangles;
};

/// Reads the vertices; counts them with Document::claim() first. Throws Failure.
Vertices read_vertices(Document& document, const Field& primitive);

/// Reads the triangles of modes 4, 5 and 6, every index below `vertex_count`. Throws Failure.
std::vector<Triangle> read_triangles(Document& document, const Field& primitive, std::size_t vertex_count);

/// Whether the primitive is compressed by Draco.
bool is_draco(const Field& primitive);

/// Decodes it; kUnreadable, saying so, when built without Draco. Throws Failure.
Compressed read_draco(Document& document, const Field& primitive);

/// Integer normals and colours made good, positions and texture coordinates checked to be finite. Throws Failure.
void check_vertices(Vertices& vertices, const Field& primitive);

}  // namespace limn::formats::gltf
