#include <algorithm>
#include <filesystem>
#include <gtest/gtest.h>
#include <vector>

#include "limn/mesh/formats/gltf_document.h"

#include "support/gltf_file.h"
#include "support/mesh_source.h"
#include "support/temp_folder.h"

/// What a glTF file may cost its reader: no more than its size makes plausible, however often it repeats itself.
namespace limn {
namespace {

using formats::read_gltf;
using formats::gltf::Document;
using test::GltfFile;
using test::Json;
using test::source_of;
using test::triangle_file;

/// An accessor of zeros, which needs no data, and a primitive of it.
void add_zeros(GltfFile& file, std::size_t count) {
  file.json["accessors"].push_back({{"componentType", 5126}, {"count", count}, {"type", "VEC3"}});
  file.json["meshes"][0]["primitives"].push_back(
      {{"attributes", {{"POSITION", file.json["accessors"].size() - 1}}}, {"mode", 5}});
}

Json spelled(std::size_t times, std::size_t length) {
  Json buffers = Json::array();
  std::string uri = "data.bin";
  for (std::size_t i = 0; i < times; ++i) {
    buffers.push_back({{"byteLength", length}, {"uri", uri}});
    uri = "./" + uri;
  }
  return buffers;
}

TEST(GltfLimits, AFileUnderManySpellingsIsReadOnce) {
  const test::TempFolder folder;
  GltfFile file = triangle_file();
  folder.write("data.bin", file.bin);
  folder.write("skin.png", test::kTinyPng);
  std::filesystem::create_symlink(folder / "skin.png", folder / "link.png");
  file.json["buffers"] = spelled(3, file.bin.size());
  file.json["bufferViews"] = Json::array();
  for (int buffer = 0; buffer < 3; ++buffer)
    file.json["bufferViews"].push_back({{"buffer", buffer}, {"byteLength", file.bin.size()}});
  file.json["images"] = Json::parse(R"([{"uri":"skin.png"},{"uri":"././skin%2Epng"},{"uri":"link.png"}])");
  const std::string text = file.json.dump();
  const formats::Source source = source_of(text, folder.path());
  std::vector<std::string> notes;
  Document document(source, notes);
  for (std::size_t i = 1; i < 3; ++i) {
    EXPECT_EQ(document.view(i).bytes.data(), document.view(0).bytes.data());
    EXPECT_EQ(document.picture(i).bytes.data(), document.picture(0).bytes.data());
    EXPECT_EQ(document.picture(i).mime, "image/png");
  }
}

TEST(GltfLimits, SpellingsDoNotRaiseWhatAFileMayClaim) {
  constexpr std::size_t kLength = std::size_t{1} << 20;
  const test::TempFolder folder;
  GltfFile file = triangle_file();
  file.bin.resize(kLength);
  folder.write("data.bin", file.bin);
  file.json["buffers"] = spelled(4, kLength);
  add_zeros(file, (std::size_t{1} << 21) + kLength);
  const std::string text = file.json.dump();
  const Result<ImportedMesh> result = read_gltf(source_of(text, folder.path()));
  ASSERT_FALSE(result.has_value());
  EXPECT_NE(result.error().message.find("vertices and faces"), std::string::npos) << format_error(result.error());
}

TEST(GltfLimits, APictureIsReadOnceHoweverOftenItIsUsed) {
  const test::TempFolder folder;
  const auto path = folder.write("skin.png", test::kTinyPng);
  GltfFile file = triangle_file();
  file.json["images"] = Json::parse(R"([{"uri":"skin.png"},{"uri":"lost.png"}])");
  const std::string bytes = file.glb();
  const formats::Source source = source_of(bytes, folder.path());
  std::vector<std::string> notes;
  Document document(source, notes);
  EXPECT_EQ(document.picture(0).bytes.size(), test::kTinyPng.size());
  EXPECT_TRUE(document.picture(1).bytes.empty());
  std::filesystem::rename(path, folder / "lost.png");
  EXPECT_EQ(document.picture(0).bytes.size(), test::kTinyPng.size());
  EXPECT_TRUE(document.picture(1).bytes.empty());
}

TEST(GltfLimits, ImagesThatShareTheirBytesShareTheirBudget) {
  constexpr std::size_t kSize = std::size_t{32} << 20;
  constexpr std::size_t kUses = 11;
  GltfFile file = triangle_file();
  std::vector<char> picture(kSize);
  std::copy(test::kTinyPng.begin(), test::kTinyPng.end(), picture.begin());
  const std::size_t view = file.add_view(picture);
  for (std::size_t i = 0; i < kUses; ++i) {
    file.json["images"].push_back({{"bufferView", view}});
    file.json["textures"].push_back({{"source", i}});
    file.json["materials"].push_back({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", i}}}}}});
  }
  const std::string bytes = file.glb();
  const Result<ImportedMesh> result = read_gltf(source_of(bytes));
  ASSERT_TRUE(result.has_value()) << format_error(result.error());
  std::size_t copies = 0;
  for (const Material& material : result->mesh.materials)
    copies += material.base_color_image.empty() ? 0 : 1;
  EXPECT_EQ(copies, 1 + (std::size_t{256} << 20) / kSize);
}

TEST(GltfLimits, ReadingStopsBetweenThePrimitivesOfAMesh) {
  GltfFile file = triangle_file();
  for (int i = 0; i < 99; ++i)
    file.json["meshes"][0]["primitives"].push_back(Json(file.json["meshes"][0]["primitives"][0]));
  const std::string bytes = file.glb();
  formats::Source source = source_of(bytes);
  std::vector<double> reports;
  source.progress = [&](std::string_view, double done) {
    reports.push_back(done);
    return done < 0.5;
  };
  const Result<ImportedMesh> result = read_gltf(source);
  ASSERT_FALSE(result.has_value());
  EXPECT_EQ(result.error().code, ErrorCode::kCancelled);
  EXPECT_TRUE(std::is_sorted(reports.begin(), reports.end()));
  EXPECT_GT(reports.size(), 10u);
  EXPECT_LT(reports.back(), 0.6);
}

#ifdef LIMN_TEST_MESHOPTIMIZER

/// Zeros as the vertex codec packs them best: a stream that grows about 64 times.
struct Stream {
  std::size_t count;
  std::string bytes;
};

Stream zeros(std::size_t blocks) {
  constexpr std::size_t kStride = 12;
  constexpr std::size_t kVerticesOfBlock = 256;
  constexpr std::size_t kHeadersOfByte = 4;  // two bits for each 16 vertices
  constexpr std::size_t kTail = 32;
  std::string bytes(1 + blocks * kStride * kHeadersOfByte + kTail, '\0');
  bytes[0] = '\xa0';
  return {blocks * kVerticesOfBlock, std::move(bytes)};
}

/// Views of one stream, and a primitive of the first three positions of each.
GltfFile shared_stream(const Stream& stream, std::size_t views) {
  GltfFile file = triangle_file();
  Json& json = file.json;
  const std::size_t offset = file.bin.size();
  file.append(std::vector<char>(stream.bytes.begin(), stream.bytes.end()));
  for (std::size_t i = 0; i < views; ++i) {
    const Json extension = {{"buffer", 0},      {"byteOffset", offset},  {"byteLength", stream.bytes.size()},
                            {"byteStride", 12}, {"count", stream.count}, {"mode", "ATTRIBUTES"}};
    json["bufferViews"].push_back({{"buffer", 0},
                                   {"byteLength", 12 * stream.count},
                                   {"byteStride", 12},
                                   {"extensions", {{"EXT_meshopt_compression", extension}}}});
    json["accessors"].push_back(
        {{"bufferView", json["bufferViews"].size() - 1}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}});
    json["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", json["accessors"].size() - 1}}}});
  }
  return file;
}

TEST(GltfLimits, AStreamThatGrowsAsFarAsItsCodecAllowsIsRead) {
  const std::string bytes = shared_stream(zeros(8000), 1).glb();
  const Result<ImportedMesh> result = read_gltf(source_of(bytes));
  ASSERT_TRUE(result.has_value()) << format_error(result.error());
  EXPECT_EQ(result->mesh.faces.size(), 2u);
}

TEST(GltfLimits, ViewsThatShareAStreamShareABudget) {
  const std::string bytes = shared_stream(zeros(1300), 40).glb();
  const Result<ImportedMesh> result = read_gltf(source_of(bytes));
  ASSERT_FALSE(result.has_value());
  EXPECT_EQ(result.error().code, ErrorCode::kUnreadable);
  EXPECT_NE(result.error().where.find("EXT_meshopt_compression.count"), std::string::npos) << result.error().where;
  EXPECT_NE(result.error().message.find("decompressed data"), std::string::npos) << format_error(result.error());
}

TEST(GltfLimits, DecompressedBytesDoNotRaiseWhatAFileMayClaim) {
  GltfFile file = shared_stream(zeros(5000), 1);
  add_zeros(file, (std::size_t{1} << 22) / 2 + (std::size_t{1} << 19));
  const std::string bytes = file.glb();
  const Result<ImportedMesh> result = read_gltf(source_of(bytes));
  ASSERT_FALSE(result.has_value());
  EXPECT_NE(result.error().message.find("vertices and faces"), std::string::npos) << format_error(result.error());
}

#endif

}  // namespace
}  // namespace limn
