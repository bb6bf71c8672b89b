#include <algorithm>
#include <functional>
#include <gtest/gtest.h>
#include <limits>
#include <sys/stat.h>

#include "support/gltf_file.h"
#include "support/mesh_source.h"
#include "support/temp_folder.h"

namespace limn {
namespace {

using formats::read_gltf;
using test::GltfFile;
using test::Json;
using test::source_of;
using test::triangle_file;

struct Broken {
  const char* pointer;  ///< the JSON field to replace
  Json value;
  const char* where;
  const char* message;
};

void expect_refused(const std::string& bytes, const std::string& what, std::string_view where, std::string_view message,
                    ErrorCode code = ErrorCode::kUnreadable, const std::filesystem::path& folder = {}) {
  const Result<ImportedMesh> result = read_gltf(source_of(bytes, folder));
  ASSERT_FALSE(result.has_value()) << what;
  EXPECT_EQ(result.error().code, code) << what;
  EXPECT_EQ(result.error().file, "model") << what;
  EXPECT_EQ(result.error().where, where) << what << ": " << format_error(result.error());
  EXPECT_NE(result.error().message.find(message), std::string::npos) << what << ": " << format_error(result.error());
}

TEST(GltfBroken, FieldsOutOfRangeAreNamedWithTheirCause) {
  const std::vector<Broken> cases = {
      {"/asset", nullptr, "asset", "object"},
      {"/asset/version", "1.0", "asset.version", "only glTF 2"},
      {"/asset/minVersion", "2.7", "asset.minVersion", "asks for glTF 2.7"},
      {"/scene", 1, "scene", "is 1, but scenes has 1"},
      {"/scenes/0/nodes/0", 5, "scenes[0].nodes[0]", "is 5"},
      {"/nodes/0/mesh", 1, "nodes[0].mesh", "is 1, but meshes has 1"},
      {"/nodes/0/children", {0}, "nodes[0]", "cycle"},
      {"/nodes/0/children", {7}, "nodes[0].children[0]", "is 7"},
      {"/nodes/0/matrix", {1, 2, 3}, "nodes[0].matrix", "16 numbers"},
      {"/meshes/0/primitives/0/attributes", Json::object(), "meshes[0].primitives[0].attributes.POSITION", "missing"},
      {"/meshes/0/primitives/0/attributes/POSITION", 9, "meshes[0].primitives[0].attributes.POSITION", "is 9"},
      {"/meshes/0/primitives/0/attributes/NORMAL", 1, "accessors[1].type", "does not fit"},
      {"/meshes/0/primitives/0/indices", 0, "accessors[0].type", "does not fit"},
      {"/meshes/0/primitives/0/mode", 7, "meshes[0].primitives[0].mode", "0 to 6"},
      {"/meshes/0/primitives/0/material", 0, "meshes[0].primitives[0].material", "is 0, but materials has 0"},
      {"/accessors/0/count", 4, "accessors[0]", "past the end"},
      {"/accessors/0/count", 4000000000u, "accessors[0].count", "too many"},
      {"/accessors/0/count", 9007199254740992u, "accessors[0].count", "too many"},
      {"/accessors/0/count", -3, "accessors[0].count", "whole number"},
      {"/accessors/0/count", 1.5, "accessors[0].count", "whole number"},
      {"/accessors/0/count", 1, "meshes[0].primitives[0]", "index 1 names vertex 1, but there are 1"},
      {"/accessors/1/count", 2, "meshes[0].primitives[0]", "not a multiple of 3"},
      {"/accessors/0/byteOffset", 8, "accessors[0]", "past the end"},
      {"/accessors/0/byteOffset", 9007199254740992u, "accessors[0]", "past the end"},
      {"/accessors/0/componentType", 5124, "accessors[0].componentType", "not a component type"},
      {"/accessors/0/type", "VEC9", "accessors[0].type", "does not fit"},
      {"/accessors/0/normalized", true, "accessors[0].normalized", "cannot be set"},
      {"/accessors/1/componentType", 5126, "accessors[1].componentType", "unsigned"},
      {"/accessors/0/bufferView", 2, "accessors[0].bufferView", "is 2"},
      {"/accessors/0/sparse", {{"count", 4}}, "accessors[0].sparse.count", "is 4, of 3"},
      {"/bufferViews/0/byteLength", 1000, "bufferViews[0]", "which has"},
      {"/bufferViews/0/byteOffset", 9007199254740992u, "bufferViews[0]", "which has"},
      {"/bufferViews/0/byteStride", 4, "accessors[0]", "12 bytes, 4 apart"},
      {"/bufferViews/0/byteStride", 4096, "bufferViews[0].byteStride", "more than 252"},
      {"/bufferViews/0/buffer", 1, "bufferViews[0].buffer", "is 1"},
      {"/buffers", Json::parse(R"([{"byteLength":3221225472}])"), "buffers[0].byteLength", "claims 3221225472 bytes"},
      {"/extensionsRequired", {"EXT_unheard_of"}, "extensionsRequired[0]", "EXT_unheard_of, which is not supported"},
      {"/materials", Json::parse(R"([{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}])"),
       "materials[0].pbrMetallicRoughness.baseColorTexture.index", "textures has 0"},
  };
  for (const Broken& broken : cases) {
    GltfFile file = triangle_file();
    file.json[Json::json_pointer(broken.pointer)] = broken.value;
    expect_refused(file.glb(), broken.pointer + (" = " + broken.value.dump()), broken.where, broken.message);
  }
}

TEST(GltfBroken, SparseIndicesMustLieWithin) {
  GltfFile file = triangle_file();
  const std::size_t indices = file.add_view<std::uint8_t>({3});
  const std::size_t values = file.add_view<float>({7, 8, 9});
  file.json["accessors"][0]["sparse"] = {{"count", 1},
                                         {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                                         {"values", {{"bufferView", values}}}};
  expect_refused(file.glb(), "sparse", "accessors[0].sparse.indices", "names element 3 of 3");
}

TEST(GltfBroken, CyclesAndSharedChildrenOfNodesAreRefused) {
  for (const auto& [nodes, where] :
       {std::pair{R"([{"children":[1]},{"children":[0],"mesh":0}])", "nodes[0]"},
        std::pair{R"([{"children":[1,2]},{"children":[2]},{"mesh":0}])", "nodes[1].children[0]"},
        std::pair{R"([{"mesh":0},{"children":[2]},{"children":[3]},{"children":[1]}])", "nodes[1]"}}) {
    GltfFile file = triangle_file();
    file.json["nodes"] = Json::parse(nodes);
    expect_refused(file.glb(), nodes, where, "");
    file.json.erase("scenes");
    file.json.erase("scene");
    expect_refused(file.glb(), nodes, where, "");
  }
}

TEST(GltfBroken, ALongChainOfNodesIsRead) {
  GltfFile file = triangle_file();
  file.json["nodes"] = Json::array();
  constexpr int kNodes = 50000;
  for (int i = 0; i < kNodes - 1; ++i)
    file.json["nodes"].push_back({{"children", {i + 1}}});
  file.json["nodes"].push_back({{"mesh", 0}});
  const Result<ImportedMesh> result = read_gltf(source_of(file.glb()));
  ASSERT_TRUE(result.has_value()) << format_error(result.error());
  EXPECT_EQ(result->mesh.faces.size(), 1u);
}

TEST(GltfBroken, NodesThatMultiplyAMeshBeyondReasonAreRefused) {
  GltfFile file = triangle_file();
  auto& accessor = file.json["accessors"][0];
  accessor = {{"componentType", 5126}, {"type", "VEC3"}, {"count", 300000}};
  file.json["nodes"] = Json::array();
  file.json["scenes"][0]["nodes"] = Json::array();
  for (int i = 0; i < 1000; ++i) {
    file.json["nodes"].push_back({{"mesh", 0}});
    file.json["scenes"][0]["nodes"].push_back(i);
  }
  expect_refused(file.glb(), "1000 × 300000 vertices", "accessors[0].count", "too many");
}

TEST(GltfBroken, CoordinatesThatAreNotFiniteMakeItUnsuitable) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  GltfFile file = triangle_file();
  file.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] =
      file.add_accessor<float>({0, 0, 0, 1, nan, 0, 0, 1, 0}, 5126, "VEC3");
  expect_refused(file.glb(), "NaN", "meshes[0].primitives[0]", "vertex 1 has a position", ErrorCode::kUnsuitable);
  file = triangle_file();
  file.json["nodes"][0]["scale"] = {1e300, 1, 1};
  expect_refused(file.glb(), "scale", "meshes[0].primitives[0]", "vertex 1 is not finite once", ErrorCode::kUnsuitable);
}

TEST(GltfBroken, EveryTruncationIsAnError) {
  const GltfFile file = triangle_file();
  for (const std::string& whole : {file.glb(), file.gltf()}) {
    for (std::size_t length = 0; length < whole.size(); ++length) {
      const std::string part = whole.substr(0, length);
      const Result<ImportedMesh> result = read_gltf(source_of(part));
      ASSERT_FALSE(result.has_value()) << length;
      ASSERT_EQ(result.error().code, ErrorCode::kUnreadable);
      ASSERT_FALSE(result.error().message.empty());
    }
  }
}

TEST(GltfBroken, ContainersWithWrongLengthsAreRefused) {
  const std::string good = triangle_file().glb();
  const auto patched = [&good](std::size_t at, std::uint32_t word) {
    std::string bytes = good;
    for (std::size_t k = 0; k < 4; ++k)
      bytes[at + k] = static_cast<char>(word >> (8 * k) & 255u);
    return bytes;
  };
  expect_refused("", "empty", "", "empty");
  expect_refused("glTF", "magic only", "header", "ends within");
  expect_refused(patched(4, 1), "version 1", "header", "version 1");
  expect_refused(patched(8, 0xffffffffu), "length", "header", "claims 4294967295 bytes");
  expect_refused(patched(8, 40), "length", "chunk 0", "are left");
  expect_refused(patched(12, 0xfffffff0u), "chunk length", "chunk 0", "claims 4294967280 bytes");
  expect_refused(patched(16, 0x12345678u), "chunk type", "chunk 0", "must be JSON");
}

TEST(GltfBroken, MalformedJsonIsRefusedAndDeepNestingDoesNoHarm) {
  const std::string open(100000, '['), close(100000, ']');
  expect_refused(open, "open", "byte 100001", "malformed JSON");
  expect_refused(open + close, "an array", "", "must be an object");
  expect_refused("{\"asset\":" + open + close + "}", "asset", "asset", "must be an object");
  expect_refused("{}", "no asset", "asset", "is missing");
  expect_refused("{\"asset\":{\"version\":\"2.0\"},\"x\":1e999}", "huge number", "", "malformed JSON");
  expect_refused("{\"asset\":{\"version\":\"\xff\"}}", "not UTF-8", "byte 22", "malformed JSON");
  const std::string extras = "{\"asset\":{\"version\":\"2.0\"},\"extras\":" + open + close + "}";
  EXPECT_TRUE(read_gltf(source_of(extras)).has_value());
}

/// Whether everything in the mesh that a caller will follow lies within it.
bool is_sound(const Mesh& mesh) {
  for (const Triangle& t : mesh.faces) {
    for (const VertexId v : t) {
      if (v >= mesh.positions.size()) return false;
    }
  }
  for (const std::uint32_t m : mesh.face_materials) {
    if (m >= mesh.materials.size()) return false;
  }
  return mesh.normals.empty() || !mesh.normals.indices.empty() || mesh.normals.values.size() == mesh.positions.size();
}

TEST(GltfBroken, AnyTypeInAnyFieldIsReadSoundlyOrRefusedWithAMessage) {
  GltfFile file = triangle_file();
  file.add_normals();
  file.json["extensionsUsed"] = {"KHR_texture_transform"};
  file.json["nodes"] =
      Json::parse(R"([{"children":[1],"translation":[1,2,3]},{"mesh":0,"rotation":[0,0,0,1],"scale":[1,1,1]}])");
  file.json["materials"] =
      Json::parse(R"([{"name":"m","doubleSided":true,"pbrMetallicRoughness":{"baseColorFactor":[1,1,1,1],
      "metallicFactor":0.5,"baseColorTexture":{"index":0,"texCoord":0}}}])");
  file.json["textures"] = Json::parse(R"([{"source":0}])");
  file.json["images"] = Json::parse(R"([{"uri":"data:image/png;base64,iVBORw0KGgo="}])");
  file.json["meshes"][0]["primitives"][0]["material"] = 0;
  file.json["buffers"] = Json::array({{{"byteLength", file.bin.size()}}});
  const Json values[] = {nullptr,
                         true,
                         -1,
                         0,
                         1,
                         2,
                         1.5,
                         1e18,
                         4294967295u,
                         "text",
                         "",
                         Json::array(),
                         Json::object(),
                         Json::parse("[[]]"),
                         Json::parse("[-1]"),
                         Json::parse("[null,null,null]")};
  std::vector<std::string> pointers;
  const std::function<void(const Json&, const std::string&)> collect = [&](const Json& json, const std::string& at) {
    pointers.push_back(at);
    if (!json.is_structured()) return;
    for (const auto& [key, value] : json.items())
      collect(value, at + "/" + key);
  };
  collect(file.json, "");
  ASSERT_GT(pointers.size(), 60u);
  std::size_t refused = 0;
  for (const std::string& pointer : pointers) {
    for (const Json& value : values) {
      Json broken = file.json;
      broken[Json::json_pointer(pointer)] = value;
      const std::string bytes = test::pack_glb(broken.dump(), file.bin);
      const Result<ImportedMesh> result = read_gltf(source_of(bytes));
      if (result) {
        EXPECT_TRUE(is_sound(result->mesh)) << pointer << " = " << value;
      } else {
        ++refused;
        EXPECT_FALSE(result.error().message.empty()) << pointer << " = " << value;
      }
    }
  }
  EXPECT_GT(refused, pointers.size() * 8);
}

class GltfReferences : public testing::Test {
 protected:
  GltfReferences() : folder_(outer_.path() / "in") {
    std::filesystem::create_directories(folder_);
    file_ = triangle_file();
    // Reading any of these would make the model good, so that an error proves they were not read.
    outer_.write("outside.bin", file_.bin);
    outer_.write("in/inside.bin", file_.bin);
    outer_.write("in/sub/deep file.bin", file_.bin);
    std::filesystem::create_symlink(outer_ / "outside.bin", folder_ / "link.bin");
    std::filesystem::create_directory_symlink(outer_.path(), folder_ / "up");
    ::mkfifo((folder_ / "pipe.bin").c_str(), 0600);
  }

  std::string with_buffer(const std::string& uri) {
    file_.json["buffers"] = Json::array({{{"byteLength", file_.bin.size()}, {"uri", uri}}});
    return file_.json.dump();
  }

  std::string with_image(const std::string& uri) {
    GltfFile file = triangle_file();
    file.json["images"] = Json::array({{{"uri", uri}}});
    return file.gltf();
  }

  std::vector<std::string> outside() const {
    const std::string path = (outer_ / "outside.bin").string();
    return {path,
            "file://" + path,
            "file:" + path,
            "../outside.bin",
            "sub/../../outside.bin",
            "%2e%2e/outside.bin",
            "%2E%2E%2Foutside.bin",
            "..%2foutside.bin",
            "..\\outside.bin",
            "%5c..%5coutside.bin",
            "sub%2F..%2F..%2Foutside.bin",
            std::string("%2F").append(path, 1),
            "http://localhost/outside.bin",
            "https://localhost/outside.bin",
            "ftp://localhost/outside.bin",
            "HTTP://localhost/x",
            "C:outside.bin",
            "sub/C:outside.bin",
            "%66ile%3A" + path,
            "inside.bin%00",
            "~/x/../../outside.bin",
            ""};
  }

  test::TempFolder outer_;
  std::filesystem::path folder_;
  GltfFile file_;
};

TEST_F(GltfReferences, InsideTheFolderAreFollowed) {
  for (const char* uri : {"inside.bin", "sub/deep%20file.bin", "sub/deep file.bin", "./inside.bin"}) {
    const std::string text = with_buffer(uri);
    const Result<ImportedMesh> result = read_gltf(source_of(text, folder_));
    ASSERT_TRUE(result.has_value()) << uri << ": " << format_error(result.error());
    EXPECT_EQ(result->mesh.faces.size(), 1u);
  }
}

TEST_F(GltfReferences, OutsideTheFolderAreErrorsAndNothingIsReadThere) {
  for (const std::string& uri : outside())
    expect_refused(with_buffer(uri), uri, "buffers[0].uri", "", ErrorCode::kUnreadable, folder_);
  const Result<ImportedMesh> result = read_gltf(source_of(with_buffer("../outside.bin"), folder_));
  EXPECT_NE(result.error().message.find("nothing was read there"), std::string::npos);
}

TEST_F(GltfReferences, LinksOutOfTheFolderAndPipesAreErrors) {
  for (const char* uri : {"link.bin", "up/outside.bin", "pipe.bin", "sub", "missing.bin"}) {
    expect_refused(with_buffer(uri), uri, "buffers[0].uri", "", ErrorCode::kUnreadable, folder_);
  }
}

TEST_F(GltfReferences, OfUnusedBuffersAndPicturesAreHeldToTheSame) {
  for (const std::string& uri : outside())
    expect_refused(with_image(uri), uri, "images[0].uri", "", ErrorCode::kUnreadable, folder_);
}

TEST_F(GltfReferences, AreErrorsWhenTheModelDoesNotComeFromAFile) {
  expect_refused(with_buffer("inside.bin"), "memory", "buffers[0].uri", "not read from a folder");
}

TEST_F(GltfReferences, DataUrisMustBeWholeBase64) {
  for (const char* uri : {"data:application/octet-stream,plain", "data:;base64", "data:;base64,A", "data:;base64,AA*A",
                          "data:;base64,AAAA"}) {
    const Result<ImportedMesh> result = read_gltf(source_of(with_buffer(uri), folder_));
    ASSERT_FALSE(result.has_value()) << uri;
    EXPECT_EQ(result.error().code, ErrorCode::kUnreadable);
  }
}

}  // namespace
}  // namespace limn
