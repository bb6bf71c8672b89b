#include <cstring>

#include "limn/mesh/formats/formats.h"
#include "limn/mesh/formats/stl_kind.h"
#include "limn/mesh/formats/text.h"
#include "limn/mesh/normals.h"

namespace limn::formats {
namespace {

void append_vector(std::string& text, const Vec3& v) {
  for (const float value : {v.x, v.y, v.z}) {
    text += ' ';
    append_number(text, value);
  }
}

std::string binary_stl(const Mesh& mesh) {
  // Not "solid": readers would take the file for text.
  constexpr std::string_view kTitle = "binary STL";
  std::string bytes(kStlHeaderSize + mesh.faces.size() * kStlFacetSize, '\0');
  std::memcpy(bytes.data(), kTitle.data(), kTitle.size());
  const auto count = static_cast<std::uint32_t>(mesh.faces.size());
  std::memcpy(bytes.data() + kStlHeaderSize - sizeof count, &count, sizeof count);
  char* at = bytes.data() + kStlHeaderSize;
  const std::vector<Vec3> normals = face_normals(mesh);
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    const Triangle& face = mesh.faces[i];
    const Vec3 corners[3] = {mesh.positions[face[0]], mesh.positions[face[1]], mesh.positions[face[2]]};
    const Vec3& normal = normals[i];
    std::memcpy(at, &normal, sizeof normal);
    std::memcpy(at + sizeof normal, corners, sizeof corners);
    at += kStlFacetSize;
  }
  return bytes;
}

std::string text_stl(const Mesh& mesh) {
  constexpr std::size_t kTypicalFacet = 230;
  std::string text = "solid mesh\n";
  text.reserve(mesh.faces.size() * kTypicalFacet);
  const std::vector<Vec3> normals = face_normals(mesh);
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    text += "facet normal";
    append_vector(text, normals[i]);
    text += "\n outer loop\n";
    for (const VertexId vertex : mesh.faces[i]) {
      text += "  vertex";
      append_vector(text, mesh.positions[vertex]);
      text += '\n';
    }
    text += " endloop\nendfacet\n";
  }
  return text + "endsolid mesh\n";
}

}  // namespace

Result<std::vector<OutputFile>> write_stl(const Mesh& mesh, const std::filesystem::path& path, bool ascii) {
  return std::vector<OutputFile>{{path, ascii ? text_stl(mesh) : binary_stl(mesh)}};
}

}  // namespace limn::formats
