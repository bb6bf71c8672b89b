#pragma once

#include <cstdint>
#include <cstdlib>
#include <span>

#include "limn/mesh/import.h"

namespace limn::fuzz {

/// Reads the bytes as a file of a format and stops the program when a mesh breaks what read_mesh() guarantees: indices
/// in range, coordinates finite, counts consistent.
inline int read(const std::uint8_t* data, std::size_t size, MeshFormat format) {
  const Result<ImportedMesh> imported = read_mesh(std::as_bytes(std::span(data, size)), format, "fuzz");
  if (!imported) return 0;
  const Mesh& mesh = imported->mesh;
  for (const Triangle& face : mesh.faces) {
    for (const VertexId vertex : face) {
      if (vertex >= mesh.positions.size()) std::abort();
    }
  }
  for (const Vec3& position : mesh.positions) {
    if (!is_finite(position)) std::abort();
  }
  const auto check = [&](const auto& attribute) {
    if (attribute.empty()) return;
    const bool by_corner = !attribute.indices.empty();
    if (by_corner && attribute.indices.size() != 3 * mesh.faces.size()) std::abort();
    if (!by_corner && attribute.values.size() != mesh.positions.size()) std::abort();
    for (const std::uint32_t index : attribute.indices) {
      if (index >= attribute.values.size()) std::abort();
    }
  };
  check(mesh.normals);
  check(mesh.uvs);
  check(mesh.colors);
  return 0;
}

}  // namespace limn::fuzz
