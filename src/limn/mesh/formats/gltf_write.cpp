#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "limn/mesh/formats/base64.h"
#include "limn/mesh/formats/formats.h"

namespace limn::formats {
namespace {

// Keys keep the order they are written in: the same mesh gives the same bytes.
using Json = nlohmann::ordered_json;

enum Target { kNone = 0, kVertices = 34962, kIndices = 34963 };
enum ComponentType { kUnsignedShort = 5123, kUnsignedInt = 5125, kFloat = 5126 };

void append_word(std::string& bytes, std::uint32_t word) {
  for (int k = 0; k < 4; ++k)
    bytes += static_cast<char>(word >> (8 * k) & 255u);
}

void append_float(std::string& bytes, float value) {
  append_word(bytes, std::bit_cast<std::uint32_t>(value));
}

/// glTF asks for normals of unit length; those that are keep their bits.
Vec3 unit_normal(const Vec3& n) {
  const DVec3 d(n);
  const double length = std::sqrt(glm::dot(d, d));
  if (std::abs(length - 1.0) < 1e-4) return n;
  return length > 0.0 && std::isfinite(length) ? Vec3(d / length) : Vec3(0.0f, 0.0f, 1.0f);
}

/// Likewise tangents; those of faces without extent in the picture are zero.
Vec4 unit_tangent(const Vec4& t) {
  const Vec3 along(t);
  const float length = glm::dot(along, along);
  const bool usable = length > 0.0f && std::isfinite(length);
  return Vec4(usable ? unit_normal(along) : Vec3(1, 0, 0), t.w < 0.0f ? -1.0f : 1.0f);
}

float unit_interval(float value) {
  return value > 0.0f ? std::min(value, 1.0f) : 0.0f;
}

/// The binary data and the JSON that describes it, grown together.
class Builder {
 public:
  explicit Builder(const Mesh& mesh) : mesh_(mesh), vertices_(one_value_per_vertex(mesh)) {}

  void build();
  void add_extension(const GltfExtension& extension);
  const Json& json() const { return json_; }
  Json& json() { return json_; }
  const std::string& data() const { return data_; }

 private:
  std::size_t begin_view() const { return data_.size(); }
  std::size_t end_view(std::size_t begin, Target target);
  std::size_t add_accessor(std::size_t view, ComponentType type, std::size_t count, const char* shape);
  template <class Vector, class Change>
  std::size_t add_attribute(const std::vector<Vector>& values, const char* shape, const Change& change);
  std::size_t add_positions();
  std::size_t add_indices(const std::vector<std::uint32_t>& faces);
  Json add_primitives();
  void add_materials();
  Json normal_texture(const Material& material);
  Json picture(const std::vector<std::byte>& image, const std::string& mime);
  std::vector<std::vector<std::uint32_t>> faces_by_material() const;

  const Mesh& mesh_;
  VertexMesh vertices_;
  std::vector<std::pair<const std::vector<std::byte>*, std::size_t>> textures_;
  Json json_;
  std::string data_;
};

std::size_t Builder::end_view(std::size_t begin, Target target) {
  Json view = {{"buffer", 0}, {"byteOffset", begin}, {"byteLength", data_.size() - begin}};
  if (target != kNone) view["target"] = static_cast<int>(target);
  data_.resize((data_.size() + 3) / 4 * 4, '\0');
  json_["bufferViews"].push_back(std::move(view));
  return json_["bufferViews"].size() - 1;
}

std::size_t Builder::add_accessor(std::size_t view, ComponentType type, std::size_t count, const char* shape) {
  json_["accessors"].push_back(
      {{"bufferView", view}, {"componentType", static_cast<int>(type)}, {"count", count}, {"type", shape}});
  return json_["accessors"].size() - 1;
}

template <class Vector, class Change>
std::size_t Builder::add_attribute(const std::vector<Vector>& values, const char* shape, const Change& change) {
  const std::size_t begin = begin_view();
  for (const Vector& value : values) {
    const Vector changed = change(value);
    for (int c = 0; c < Vector::length(); ++c)
      append_float(data_, changed[c]);
  }
  return add_accessor(end_view(begin, kVertices), kFloat, values.size(), shape);
}

std::size_t Builder::add_positions() {
  const std::size_t accessor = add_attribute(vertices_.positions, "VEC3", [](const Vec3& p) { return p; });
  const Bounds bounds = bounds_of(vertices_.positions);
  json_["accessors"][accessor]["min"] = {bounds.low.x, bounds.low.y, bounds.low.z};
  json_["accessors"][accessor]["max"] = {bounds.high.x, bounds.high.y, bounds.high.z};
  return accessor;
}

std::size_t Builder::add_indices(const std::vector<std::uint32_t>& faces) {
  // The largest value of a type is kept for restarting strips and must not be an index.
  const bool small = vertices_.positions.size() <= std::numeric_limits<std::uint16_t>::max();
  const std::size_t begin = begin_view();
  for (const std::uint32_t f : faces) {
    for (const VertexId v : vertices_.faces[f]) {
      if (small) {
        data_ += static_cast<char>(v & 255u);
        data_ += static_cast<char>(v >> 8);
      } else {
        append_word(data_, v);
      }
    }
  }
  return add_accessor(end_view(begin, kIndices), small ? kUnsignedShort : kUnsignedInt, 3 * faces.size(), "SCALAR");
}

std::vector<std::vector<std::uint32_t>> Builder::faces_by_material() const {
  std::vector<std::vector<std::uint32_t>> groups(std::max<std::size_t>(mesh_.materials.size(), 1));
  for (std::size_t f = 0; f < mesh_.faces.size(); ++f) {
    const std::size_t material = mesh_.face_materials.empty() || mesh_.materials.empty() ? 0 : mesh_.face_materials[f];
    groups[material].push_back(static_cast<std::uint32_t>(f));
  }
  return groups;
}

Json Builder::add_primitives() {
  Json attributes = {{"POSITION", add_positions()}};
  if (!vertices_.normals.empty()) attributes["NORMAL"] = add_attribute(vertices_.normals, "VEC3", unit_normal);
  // Without normals glTF ignores tangents.
  if (!vertices_.normals.empty() && !vertices_.tangents.empty())
    attributes["TANGENT"] = add_attribute(vertices_.tangents, "VEC4", unit_tangent);
  if (!vertices_.uvs.empty()) {
    attributes["TEXCOORD_0"] =
        add_attribute(vertices_.uvs, "VEC2", [](const Vec2& uv) { return Vec2(uv.x, 1.0f - uv.y); });
  }
  if (!vertices_.colors.empty()) {
    attributes["COLOR_0"] = add_attribute(vertices_.colors, "VEC4", [](const Vec4& c) {
      return Vec4(unit_interval(c.r), unit_interval(c.g), unit_interval(c.b), unit_interval(c.a));
    });
  }
  Json primitives = Json::array();
  const std::vector<std::vector<std::uint32_t>> groups = faces_by_material();
  for (std::size_t material = 0; material < groups.size(); ++material) {
    if (groups[material].empty()) continue;
    Json primitive = {{"attributes", attributes}, {"indices", add_indices(groups[material])}};
    if (!mesh_.materials.empty()) primitive["material"] = material;
    primitives.push_back(std::move(primitive));
  }
  return primitives;
}

/// A texture, with the image and view it needs; one for all uses of the same picture.
Json Builder::picture(const std::vector<std::byte>& image, const std::string& mime) {
  for (const auto& [earlier, texture] : textures_) {
    if (*earlier == image) return {{"index", texture}};
  }
  const std::size_t begin = begin_view();
  data_.append(reinterpret_cast<const char*>(image.data()), image.size());
  json_["images"].push_back({{"bufferView", end_view(begin, kNone)}, {"mimeType", mime}});
  json_["textures"].push_back({{"source", json_["images"].size() - 1}});
  textures_.emplace_back(&image, json_["textures"].size() - 1);
  return {{"index", textures_.back().second}};
}

Json Builder::normal_texture(const Material& material) {
  Json texture = picture(material.normal_image, material.normal_image_mime);
  const bool plain = material.normal_scale == 1.0f || !std::isfinite(material.normal_scale);
  if (!plain) texture["scale"] = material.normal_scale;
  return texture;
}

void Builder::add_materials() {
  for (const Material& material : mesh_.materials) {
    Json entry;
    if (!material.name.empty()) entry["name"] = material.name;
    const Vec4& color = material.base_color;
    Json pbr = {{"baseColorFactor",
                 {unit_interval(color.r), unit_interval(color.g), unit_interval(color.b), unit_interval(color.a)}}};
    // A texture without coordinates to look it up with would make the file invalid.
    const bool pictures = !vertices_.uvs.empty();
    if (pictures && !material.base_color_image.empty())
      pbr["baseColorTexture"] = picture(material.base_color_image, material.base_color_image_mime);
    pbr["metallicFactor"] = unit_interval(material.metallic);
    pbr["roughnessFactor"] = unit_interval(material.roughness);
    entry["pbrMetallicRoughness"] = std::move(pbr);
    if (pictures && !material.normal_image.empty()) entry["normalTexture"] = normal_texture(material);
    if (color.a < 1.0f) entry["alphaMode"] = "BLEND";
    if (material.double_sided) entry["doubleSided"] = true;
    json_["materials"].push_back(std::move(entry));
  }
}

void Builder::build() {
  json_["asset"] = {{"version", "2.0"}, {"generator", "limn " LIMN_VERSION}};
  json_["scene"] = 0;
  json_["scenes"] = Json::array({Json::object()});
  // glTF has no empty mesh: without faces there is a scene with nothing in it.
  if (mesh_.faces.empty()) return;
  json_["scenes"][0]["nodes"] = {0};
  json_["nodes"] = Json::array({{{"mesh", 0}}});
  json_["meshes"] = Json::array({Json::object()});
  json_["meshes"][0]["primitives"] = add_primitives();
  add_materials();
}

void Builder::add_extension(const GltfExtension& extension) {
  const std::size_t first = json_["bufferViews"].size();
  for (const std::vector<std::byte>& bytes : extension.views) {
    const std::size_t begin = begin_view();
    data_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    end_view(begin, kNone);
  }
  json_["extensionsUsed"] = {extension.name};
  json_["extensions"][extension.name] = Json::parse(extension.json(first));
}

std::string dump(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

/// The chunks, each padded to four bytes, behind the header; empty when their lengths do not fit its 32 bits.
std::string pack_glb(std::string json, const std::string& data) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::uint64_t total = 12 + 8 + std::uint64_t{json.size()} + (data.empty() ? 0 : 8 + std::uint64_t{data.size()});
  if (total > std::numeric_limits<std::uint32_t>::max()) return {};
  std::string bytes = "glTF";
  append_word(bytes, 2);
  append_word(bytes, static_cast<std::uint32_t>(total));
  append_word(bytes, static_cast<std::uint32_t>(json.size()));
  bytes += "JSON" + json;
  if (data.empty()) return bytes;
  append_word(bytes, static_cast<std::uint32_t>(data.size()));
  bytes += std::string("BIN\0", 4);
  bytes += data;
  return bytes;
}

Result<void> check(const Mesh& mesh, const std::filesystem::path& path) {
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    if (is_finite(mesh.positions[i])) continue;
    return fail_at(ErrorCode::kInvalidArgument, path.string(), fmt::format("vertex {}", i),
                   "a coordinate is not finite");
  }
  for (std::size_t f = 0; f < mesh.face_materials.size() && !mesh.materials.empty(); ++f) {
    if (mesh.face_materials[f] < mesh.materials.size()) continue;
    return fail_at(ErrorCode::kInvalidArgument, path.string(), fmt::format("face {}", f),
                   fmt::format("names material {}, but there are {}", mesh.face_materials[f], mesh.materials.size()));
  }
  return {};
}

}  // namespace

Result<std::vector<OutputFile>> write_gltf(const Mesh& mesh, const std::filesystem::path& path, bool binary,
                                           const GltfExtension* extension) {
  if (const Result<void> checked = check(mesh, path); !checked) return tl::unexpected(checked.error());
  Builder builder(mesh);
  builder.build();
  if (extension != nullptr) builder.add_extension(*extension);
  std::vector<OutputFile> files(1);
  files[0].path = path;
  if (!builder.data().empty()) {
    Json buffer = {{"byteLength", builder.data().size()}};
    if (!binary) {
      const auto bytes = std::as_bytes(std::span(builder.data().data(), builder.data().size()));
      buffer["uri"] = "data:application/octet-stream;base64," + encode_base64(bytes);
    }
    builder.json()["buffers"] = Json::array({std::move(buffer)});
  }
  files[0].bytes = binary ? pack_glb(dump(builder.json(), -1), builder.data()) : dump(builder.json(), 1) + "\n";
  if (!files[0].bytes.empty()) return files;
  return fail_at(ErrorCode::kInvalidArgument, path.string(), {}, "a GLB cannot be larger than 4 GiB",
                 "write .gltf or PLY instead");
}

}  // namespace limn::formats
