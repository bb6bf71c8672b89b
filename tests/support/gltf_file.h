#pragma once

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace limn::test {

using Json = nlohmann::json;

/// Starts like a PNG; the readers never decode it.
inline constexpr std::string_view kTinyPng = "\x89PNG\r\n\x1a\n and so on, never decoded";

/// A glTF file under construction: JSON to be broken at will, and the data of buffer 0.
struct GltfFile {
  Json json;
  std::string bin;

  template <class T>
  void append(const std::vector<T>& values) {
    const std::size_t begin = bin.size();
    bin.resize(begin + values.size() * sizeof(T));
    std::memcpy(bin.data() + begin, values.data(), values.size() * sizeof(T));
  }

  template <class T>
  std::size_t add_view(const std::vector<T>& values) {
    bin.resize((bin.size() + 3) / 4 * 4);
    const std::size_t begin = bin.size();
    append(values);
    json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", begin}, {"byteLength", bin.size() - begin}});
    return json["bufferViews"].size() - 1;
  }

  template <class T>
  std::size_t add_accessor(const std::vector<T>& values, int component_type, const std::string& type,
                           bool normalized = false) {
    const std::size_t components = type == "SCALAR" ? 1 : static_cast<std::size_t>(type.back() - '0');
    const std::size_t view = add_view(values);
    json["accessors"].push_back({{"bufferView", view},
                                 {"componentType", component_type},
                                 {"count", values.size() / components},
                                 {"type", type}});
    if (normalized) json["accessors"].back()["normalized"] = true;
    return json["accessors"].size() - 1;
  }

  /// The same normal at the three corners of the first primitive.
  void add_normals(const std::vector<float>& n = {0, 0, 1}) {
    std::vector<float> values;
    for (int i = 0; i < 3; ++i)
      values.insert(values.end(), n.begin(), n.end());
    json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = add_accessor(values, 5126, "VEC3");
  }

  /// With a GLB header and both chunks; `buffers` is filled in unless it is there.
  std::string glb() const;
  /// As text with the data embedded; `buffers` is filled in unless it is there.
  std::string gltf() const;
};

/// One triangle, (0,0,0) (1,0,0) (0,1,0), indexed, in one mesh, node and scene.
GltfFile triangle_file();

/// A GLB of any JSON text and data.
std::string pack_glb(std::string json, std::string bin);

}  // namespace limn::test
