#include <cmath>
#include <cstring>

#include "limn/mesh/formats/formats.h"
#include "limn/mesh/formats/stl_kind.h"
#include "limn/mesh/formats/text.h"

namespace limn::formats {
namespace {

/// A facet's normal from its winding; (0,0,0), which readers take as "unknown", without area.
Vec3 winding_normal(const Vec3 (&p)[3]) {
  const DVec3 u = DVec3(p[1]) - DVec3(p[0]);
  const DVec3 v = DVec3(p[2]) - DVec3(p[0]);
  const DVec3 n(u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x);
  const double length = std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
  return length > 0.0 && std::isfinite(length) ? Vec3(n / length) : Vec3(0.0f);
}

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
  for (const Triangle& face : mesh.faces) {
    const Vec3 corners[3] = {mesh.positions[face[0]], mesh.positions[face[1]], mesh.positions[face[2]]};
    const Vec3 normal = winding_normal(corners);
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
  for (const Triangle& face : mesh.faces) {
    const Vec3 corners[3] = {mesh.positions[face[0]], mesh.positions[face[1]], mesh.positions[face[2]]};
    text += "facet normal";
    append_vector(text, winding_normal(corners));
    text += "\n outer loop\n";
    for (const Vec3& corner : corners) {
      text += "  vertex";
      append_vector(text, corner);
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
