#include "limn/mesh/formats/gltf_primitive.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "limn/mesh/formats/gltf_accessor.h"

namespace limn::formats::gltf {
namespace {

constexpr std::uint64_t kNoAccessor = ~std::uint64_t{0};

/// The accessor of an attribute, whose count must be the positions'.
std::size_t attribute(Document& document, const Field& field, std::uint64_t count) {
  const std::size_t accessor = field.index_into(document["accessors"]);
  const std::uint64_t own = accessor_count(document, accessor);
  if (own != count) refuse(field.path(), fmt::format("has {} elements for {} positions", own, count));
  return accessor;
}

Vec3 unit(const Vec3& v) {
  const DVec3 d(v);
  const double length = std::sqrt(glm::dot(d, d));
  return length > 0.0 && std::isfinite(length) ? Vec3(d / length) : Vec3(0.0f);
}

std::vector<Triangle> assemble(const std::vector<std::uint32_t>& indices, std::uint64_t mode, const Field& primitive) {
  std::vector<Triangle> triangles;
  const std::size_t count = indices.size();
  if (mode == 4) {
    if (count % 3 != 0)
      refuse(primitive.path(), fmt::format("has {} corners, not a multiple of 3", count), "the file may be truncated");
    triangles.reserve(count / 3);
    for (std::size_t i = 0; i < count; i += 3)
      triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
    return triangles;
  }
  for (std::size_t i = 0; i + 2 < count; ++i) {
    const Triangle triangle = mode == 6    ? Triangle{indices[i + 1], indices[i + 2], indices[0]}
                              : i % 2 == 0 ? Triangle{indices[i], indices[i + 1], indices[i + 2]}
                                           : Triangle{indices[i], indices[i + 2], indices[i + 1]};
    // Strips repeat vertices to turn corners; those triangles are not part of the surface.
    const bool stitch = triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0];
    if (!stitch) triangles.push_back(triangle);
  }
  return triangles;
}

}  // namespace

VertexKey vertex_key(const Field& primitive) {
  const Field attributes = primitive["attributes"];
  return {attributes["POSITION"].index_or(kNoAccessor), attributes["NORMAL"].index_or(kNoAccessor),
          attributes["TEXCOORD_0"].index_or(kNoAccessor), attributes["COLOR_0"].index_or(kNoAccessor)};
}

Vertices read_vertices(Document& document, const Field& primitive) {
  const Field attributes = primitive["attributes"];
  const std::size_t position = attributes["POSITION"].index_into(document["accessors"]);
  const std::uint64_t count = accessor_count(document, position);
  document.claim(count, document["accessors"].at(position)["count"].path());
  Vertices vertices;
  vertices.positions = read_vec3(document, position);
  if (const Field field = attributes["NORMAL"]) {
    const std::size_t accessor = attribute(document, field, count);
    vertices.normals = read_vec3(document, accessor);
    if (!stores_floats(document, accessor)) {
      for (Vec3& n : vertices.normals)
        n = unit(n);
    }
  }
  if (const Field field = attributes["TEXCOORD_0"])
    vertices.uvs = read_vec2(document, attribute(document, field, count));
  if (const Field field = attributes["COLOR_0"])
    vertices.colors = read_color(document, attribute(document, field, count));
  check_vertices(vertices, primitive);
  return vertices;
}

void check_vertices(Vertices& vertices, const Field& primitive) {
  const auto not_finite = [&](std::size_t i, const char* what) {
    throw Failure{primitive.path(), fmt::format("vertex {} has a {} that is not finite", i, what),
                  "repair the model where it was made", ErrorCode::kUnsuitable};
  };
  for (std::size_t i = 0; i < vertices.positions.size(); ++i) {
    if (!is_finite(vertices.positions[i])) not_finite(i, "position");
  }
  for (std::size_t i = 0; i < vertices.uvs.size(); ++i) {
    if (!std::isfinite(vertices.uvs[i].x) || !std::isfinite(vertices.uvs[i].y)) not_finite(i, "texture coordinate");
  }
  for (std::size_t i = 0; i < vertices.colors.size(); ++i) {
    if (!is_finite(Vec3(vertices.colors[i])) || !std::isfinite(vertices.colors[i].a)) not_finite(i, "colour");
  }
  for (Vec3& n : vertices.normals) {
    if (!is_finite(n)) n = Vec3(0.0f);
  }
}

std::vector<Triangle> read_triangles(Document& document, const Field& primitive, std::size_t vertex_count) {
  const std::uint64_t mode = primitive["mode"].index_or(4);
  std::vector<std::uint32_t> indices;
  if (const Field field = primitive["indices"]) {
    const std::size_t accessor = field.index_into(document["accessors"]);
    document.claim(accessor_count(document, accessor) / (mode == 4 ? 3 : 1),
                   document["accessors"].at(accessor)["count"].path());
    indices = read_indices(document, accessor);
  } else {
    document.claim(vertex_count / (mode == 4 ? 3 : 1), primitive.path());
    indices.resize(vertex_count);
    for (std::size_t i = 0; i < vertex_count; ++i)
      indices[i] = static_cast<std::uint32_t>(i);
  }
  const auto wrong = std::find_if(indices.begin(), indices.end(), [&](std::uint32_t i) { return i >= vertex_count; });
  if (wrong != indices.end()) {
    refuse(primitive.path(),
           fmt::format("index {} names vertex {}, but there are {}", wrong - indices.begin(), *wrong, vertex_count));
  }
  return assemble(indices, mode, primitive);
}

bool is_draco(const Field& primitive) {
  return primitive["extensions"]["KHR_draco_mesh_compression"].present();
}

}  // namespace limn::formats::gltf
