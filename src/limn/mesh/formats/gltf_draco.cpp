#include <fmt/format.h>

#include "limn/mesh/formats/gltf_primitive.h"

#ifdef LIMN_WITH_DRACO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wextra"
#include <draco/compression/decode.h>
#pragma GCC diagnostic pop
#endif

namespace limn::formats::gltf {

#ifdef LIMN_WITH_DRACO
namespace {

/// The values of an attribute by point, as floats; integers as in accessors.
template <class Vector>
std::vector<Vector> values(const draco::Mesh& mesh, const Field& id, std::size_t least, const Vector& initial) {
  constexpr auto kMost = static_cast<std::size_t>(Vector::length());
  const draco::PointAttribute* const attribute = mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(id.index()));
  if (attribute == nullptr) refuse(id.path(), "names no attribute of the compressed data");
  const auto components = static_cast<std::size_t>(attribute->num_components());
  if (components < least || components > kMost) refuse(id.path(), fmt::format("has {} components", components));
  std::vector<Vector> result(mesh.num_points(), initial);
  for (std::uint32_t p = 0; p < mesh.num_points(); ++p) {
    const draco::AttributeValueIndex value = attribute->mapped_index(draco::PointIndex(p));
    float components_of_point[kMost] = {};
    const bool good = value.value() < attribute->size() &&
                      attribute->ConvertValue<float>(value, static_cast<std::int8_t>(components), components_of_point);
    if (!good) refuse(id.path(), "holds a value that cannot be read");
    for (std::size_t c = 0; c < components; ++c)
      result[p][static_cast<int>(c)] = components_of_point[c];
  }
  return result;
}

}  // namespace

Compressed read_draco(Document& document, const Field& primitive) {
  const Field extension = primitive["extensions"]["KHR_draco_mesh_compression"];
  const View view = document.view(extension["bufferView"].index_into(document["bufferViews"]));
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(view.bytes.data()), view.bytes.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) {
    refuse(extension.path(), fmt::format("cannot be decoded: {}", decoded.status().error_msg_string()),
           "the file may be damaged");
  }
  const draco::Mesh& mesh = *decoded.value();
  document.claim(std::uint64_t{mesh.num_points()} + mesh.num_faces(), extension.path());
  Compressed result;
  const Field attributes = extension["attributes"];
  result.vertices.positions = values(mesh, attributes["POSITION"], 3, Vec3(0.0f));
  if (const Field id = attributes["NORMAL"]) result.vertices.normals = values(mesh, id, 3, Vec3(0.0f));
  if (const Field id = attributes["TEXCOORD_0"]) result.vertices.uvs = values(mesh, id, 2, Vec2(0.0f));
  if (const Field id = attributes["COLOR_0"])
    result.vertices.colors = values(mesh, id, 3, Vec4(0.0f, 0.0f, 0.0f, 1.0f));
  result.triangles.reserve(mesh.num_faces());
  for (std::uint32_t f = 0; f < mesh.num_faces(); ++f) {
    const draco::Mesh::Face& face = mesh.face(draco::FaceIndex(f));
    const Triangle triangle{face[0].value(), face[1].value(), face[2].value()};
    for (const VertexId v : triangle) {
      if (v >= mesh.num_points())
        refuse(extension.path(), fmt::format("triangle {} names vertex {} of {}", f, v, mesh.num_points()));
    }
    result.triangles.push_back(triangle);
  }
  check_vertices(result.vertices, primitive);
  return result;
}
#else
Compressed read_draco(Document&, const Field& primitive) {
  refuse(primitive.path(), "is compressed by KHR_draco_mesh_compression, which this build cannot decode",
         "build limn with Draco, or decompress the model: gltf-transform copy IN OUT");
}
#endif

}  // namespace limn::formats::gltf
