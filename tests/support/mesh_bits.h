#pragma once

#include <cstring>
#include <gtest/gtest.h>
#include <string>
#include <string_view>
#include <vector>

#include "limn/mesh/import.h"

namespace limn::test {

/// Whether two arrays hold the same bits: -0 differs from 0.
template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

/// The value each corner carries, face by face: what a format has to keep however it stores it. Empty without the
/// attribute.
template <class T>
std::vector<T> corner_values(const Mesh& mesh, const CornerAttribute<T>& attribute) {
  std::vector<T> values;
  if (attribute.empty()) return values;
  for (FaceId face = 0; face < mesh.faces.size(); ++face) {
    for (int corner = 0; corner < 3; ++corner)
      values.push_back(mesh.corner(attribute, face, corner));
  }
  return values;
}

/// The position of each corner, face by face.
inline std::vector<Vec3> corner_positions(const Mesh& mesh) {
  std::vector<Vec3> points;
  for (const Triangle& face : mesh.faces) {
    for (const VertexId vertex : face)
      points.push_back(mesh.positions[vertex]);
  }
  return points;
}

/// The bytes of a text, as read_mesh() takes them.
inline std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span<const char>(text.data(), text.size()));
}

/// Reads a text that has to be a good file; fails the test, giving an empty mesh, when it is not.
inline ImportedMesh must_read(std::string_view text, MeshFormat format) {
  Result<ImportedMesh> imported = read_mesh(bytes_of(text), format, "test");
  EXPECT_TRUE(imported) << format_error(imported.error());
  return imported ? std::move(*imported) : ImportedMesh{};
}

/// Appends the bytes of values, in the machine's order or the other.
template <class T>
void append_bytes(std::string& bytes, T value, bool swapped = false) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  if (swapped) {
    for (std::size_t i = 0; i < sizeof(T) / 2; ++i)
      std::swap(raw[i], raw[sizeof(T) - 1 - i]);
  }
  bytes.append(raw, sizeof(T));
}

/// A closed mesh with awkward numbers: -0, the smallest denormal, the largest float, thirds; corners that differ in
/// their attributes at shared positions when `seams` is set.
inline Mesh awkward_tetrahedron(bool seams) {
  Mesh mesh;
  mesh.positions = {Vec3(-0.0f, 1.4e-45f, 1.0f / 3.0f), Vec3(3.4028235e38f, -1e-40f, 0.1f),
                    Vec3(1e10f, -1e-10f, 16777217.0f), Vec3(-5.0f, 0.30000001192092896f, 7e20f)};
  mesh.faces = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
  const std::vector<Vec3> normals = {Vec3(1, 0, 0), Vec3(0, -0.6f, 0.8f), Vec3(-0.0f, 1, 0), Vec3(0, 0, -1)};
  const std::vector<Vec2> uvs = {Vec2(0.1f, -0.0f), Vec2(1, 0.7f), Vec2(1e-42f, 3), Vec2(0.25f, 1.0f / 7.0f)};
  const std::vector<Vec4> colors = {Vec4(0, 0.25f, 1, 1), Vec4(0.1f, 0.2f, 0.3f, 0.4f), Vec4(1), Vec4(0, 0, 0, 1)};
  mesh.normals.values = normals;
  mesh.uvs.values = uvs;
  mesh.colors.values = colors;
  mesh.tags = {0.5f, -0.0f, 1e-44f, 3};
  if (seams) {
    mesh.normals.indices = {0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3};
    mesh.uvs.indices = {0, 1, 2, 0, 1, 2, 3, 1, 2, 0, 1, 3};
    mesh.colors.indices = {0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2};
  }
  return mesh;
}

}  // namespace limn::test
