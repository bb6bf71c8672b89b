#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <optional>

#include "limn/mesh/formats/color.h"
#include "limn/mesh/formats/formats.h"
#include "limn/mesh/formats/text.h"

namespace limn::formats {
namespace {

static_assert(std::endian::native == std::endian::little, "binary PLY is written as it lies in memory");

/// How colours are stored: bytes, which every program reads, where they lose nothing; floats otherwise.
struct ColorStorage {
  bool bytes = true;
  bool alpha = false;  ///< some alpha is not 1
};

std::optional<std::uint8_t> alpha_byte_of(float alpha) {
  const float scaled = alpha * 255.0f;
  if (!(scaled >= 0.0f && scaled <= 255.0f)) return std::nullopt;
  const auto byte = static_cast<std::uint8_t>(std::lround(scaled));
  if (static_cast<float>(byte) / 255.0f != alpha) return std::nullopt;
  return byte;
}

bool is_negative_zero(float value) {
  return std::bit_cast<std::uint32_t>(value) == 0x80000000u;
}

ColorStorage storage_for(const std::vector<Vec4>& colors) {
  ColorStorage storage;
  for (const Vec4& color : colors) {
    storage.alpha = storage.alpha || color.a != 1.0f;
    for (const float value : {color.r, color.g, color.b}) {
      storage.bytes = storage.bytes && srgb_byte_of(value) && !is_negative_zero(value);
    }
    storage.bytes = storage.bytes && alpha_byte_of(color.a) && !is_negative_zero(color.a);
  }
  return storage;
}

std::string header_for(const VertexMesh& mesh, bool tags, const ColorStorage& storage, bool ascii) {
  std::string header = fmt::format("ply\nformat {} 1.0\nelement vertex {}\n", ascii ? "ascii" : "binary_little_endian",
                                   mesh.positions.size());
  header += "property float x\nproperty float y\nproperty float z\n";
  if (!mesh.normals.empty()) header += "property float nx\nproperty float ny\nproperty float nz\n";
  if (!mesh.uvs.empty()) header += "property float s\nproperty float t\n";
  if (!mesh.colors.empty()) {
    const char* const type = storage.bytes ? "uchar" : "float";
    for (const char* const name : {"red", "green", "blue"})
      header += fmt::format("property {} {}\n", type, name);
    if (storage.alpha) header += fmt::format("property {} alpha\n", type);
  }
  if (tags) header += "property float tag\n";
  // "int" is what every reader knows; beyond its range only "uint" will do.
  const bool wide = mesh.positions.size() > 0x80000000u;
  return header + fmt::format("element face {}\nproperty list uchar {} vertex_indices\nend_header\n", mesh.faces.size(),
                              wide ? "uint" : "int");
}

/// Puts values one behind the other into a buffer that is large enough.
class ByteSink {
 public:
  explicit ByteSink(char* at) : at_(at) {}
  template <class T>
  void put(const T& value) {
    std::memcpy(at_, &value, sizeof value);
    at_ += sizeof value;
  }
  void put_float(float value) { put(value); }
  void put_byte(std::uint8_t value) { put(value); }
  void end_line() {}

 private:
  char* at_;
};

/// Puts values as words of lines.
class TextSink {
 public:
  explicit TextSink(std::string& text) : text_(text) {}
  void put_float(float value) {
    begin_word();
    append_number(text_, value);
  }
  void put_byte(std::uint8_t value) {
    begin_word();
    append_number(text_, std::uint64_t{value});
  }
  void put(VertexId value) {
    begin_word();
    append_number(text_, std::uint64_t{value});
  }
  void end_line() {
    text_ += '\n';
    first_ = true;
  }

 private:
  void begin_word() {
    if (!first_) text_ += ' ';
    first_ = false;
  }
  std::string& text_;
  bool first_ = true;
};

template <class Sink>
void put_color(Sink& sink, const Vec4& color, const ColorStorage& storage) {
  for (const float value : {color.r, color.g, color.b}) {
    if (storage.bytes) {
      sink.put_byte(*srgb_byte_of(value));
    } else {
      sink.put_float(value);
    }
  }
  if (!storage.alpha) return;
  if (storage.bytes) {
    sink.put_byte(*alpha_byte_of(color.a));
  } else {
    sink.put_float(color.a);
  }
}

template <class Sink>
void put_mesh(Sink& sink, const VertexMesh& mesh, const std::vector<float>& tags, const ColorStorage& storage) {
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    for (const float value : {mesh.positions[i].x, mesh.positions[i].y, mesh.positions[i].z})
      sink.put_float(value);
    if (!mesh.normals.empty()) {
      for (const float value : {mesh.normals[i].x, mesh.normals[i].y, mesh.normals[i].z})
        sink.put_float(value);
    }
    if (!mesh.uvs.empty()) {
      for (const float value : {mesh.uvs[i].x, mesh.uvs[i].y})
        sink.put_float(value);
    }
    if (!mesh.colors.empty()) put_color(sink, mesh.colors[i], storage);
    if (!tags.empty()) sink.put_float(tags[mesh.source[i]]);
    sink.end_line();
  }
  for (const Triangle& face : mesh.faces) {
    sink.put_byte(3);
    for (const VertexId vertex : face)
      sink.put(vertex);
    sink.end_line();
  }
}

std::size_t vertex_size(const VertexMesh& mesh, bool tags, const ColorStorage& storage) {
  std::size_t size = sizeof(Vec3);
  if (!mesh.normals.empty()) size += sizeof(Vec3);
  if (!mesh.uvs.empty()) size += sizeof(Vec2);
  if (!mesh.colors.empty()) size += (storage.alpha ? 4u : 3u) * (storage.bytes ? 1 : sizeof(float));
  return size + (tags ? sizeof(float) : 0);
}

}  // namespace

Result<std::vector<OutputFile>> write_ply(const Mesh& mesh, const std::filesystem::path& path, bool ascii) {
  constexpr std::size_t kFaceSize = 1 + sizeof(Triangle);
  constexpr std::size_t kTypicalNumber = 11;
  const VertexMesh vertices = one_value_per_vertex(mesh);
  const ColorStorage storage = storage_for(vertices.colors);
  std::string bytes = header_for(vertices, !mesh.tags.empty(), storage, ascii);
  const std::size_t header_size = bytes.size();
  const std::size_t vertex_bytes = vertices.positions.size() * vertex_size(vertices, !mesh.tags.empty(), storage);
  if (ascii) {
    bytes.reserve(header_size + (vertex_bytes / sizeof(float) + 2 * mesh.faces.size()) * kTypicalNumber);
    TextSink sink(bytes);
    put_mesh(sink, vertices, mesh.tags, storage);
  } else {
    bytes.resize(header_size + vertex_bytes + mesh.faces.size() * kFaceSize);
    ByteSink sink(bytes.data() + header_size);
    put_mesh(sink, vertices, mesh.tags, storage);
  }
  return std::vector<OutputFile>{{path, std::move(bytes)}};
}

}  // namespace limn::formats
