#include "support/gltf_file.h"

namespace limn::test {
namespace {

void append_word(std::string& bytes, std::size_t word) {
  for (int k = 0; k < 4; ++k)
    bytes += static_cast<char>(word >> (8 * k) & 255u);
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  std::uint32_t group = 0;
  int bits = 0;
  for (const char c : bytes) {
    group = group << 8 | static_cast<unsigned char>(c);
    for (bits += 8; bits >= 6; bits -= 6)
      text += kDigits[group >> (bits - 6) & 63u];
  }
  if (bits > 0) text += kDigits[group << (6 - bits) & 63u];
  while (text.size() % 4 != 0)
    text += '=';
  return text;
}

}  // namespace

std::string pack_glb(std::string json, std::string bin) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  bin.resize((bin.size() + 3) / 4 * 4);
  std::string bytes = "glTF";
  append_word(bytes, 2);
  append_word(bytes, 28 + json.size() + bin.size());
  append_word(bytes, json.size());
  bytes += "JSON" + json;
  append_word(bytes, bin.size());
  return bytes + std::string("BIN\0", 4) + bin;
}

std::string GltfFile::glb() const {
  Json whole = json;
  if (!whole.contains("buffers")) whole["buffers"] = Json::array({{{"byteLength", bin.size()}}});
  return pack_glb(whole.dump(), bin);
}

std::string GltfFile::gltf() const {
  Json whole = json;
  if (!whole.contains("buffers")) {
    whole["buffers"] =
        Json::array({{{"byteLength", bin.size()}, {"uri", "data:application/octet-stream;base64," + base64(bin)}}});
  }
  return whole.dump();
}

GltfFile triangle_file() {
  GltfFile file;
  file.json = Json::parse(R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
      "meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}]})");
  file.add_accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, 5126, "VEC3");
  file.add_accessor<std::uint16_t>({0, 1, 2}, 5123, "SCALAR");
  return file;
}

}  // namespace limn::test
