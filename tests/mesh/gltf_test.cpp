#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "limn/base/random.h"

#include "support/gltf_file.h"
#include "support/mesh_source.h"
#include "support/temp_folder.h"

namespace limn {
namespace {

using formats::read_gltf;
using formats::write_gltf;
using test::bits;
using test::GltfFile;
using test::Json;
using test::source_of;
using test::triangle_file;

ImportedMesh read(std::string_view bytes, const std::filesystem::path& folder = {}) {
  Result<ImportedMesh> result = read_gltf(source_of(bytes, folder));
  EXPECT_TRUE(result.has_value()) << (result ? "" : format_error(result.error()));
  return result ? *std::move(result) : ImportedMesh{};
}

bool has_note(const ImportedMesh& mesh, std::string_view part) {
  return std::any_of(mesh.notes.begin(), mesh.notes.end(),
                     [part](const std::string& note) { return note.find(part) != std::string::npos; });
}

TEST(Gltf, ReadsTheSameFromBothContainers) {
  const GltfFile file = triangle_file();
  const ImportedMesh glb = read(file.glb());
  const ImportedMesh gltf = read(file.gltf());
  EXPECT_EQ(glb.format, MeshFormat::kGlb);
  EXPECT_EQ(gltf.format, MeshFormat::kGltf);
  EXPECT_EQ(glb.mesh.positions, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(glb.mesh.faces, (std::vector<Triangle>{{0, 1, 2}}));
  EXPECT_EQ(gltf.mesh.positions, glb.mesh.positions);
  EXPECT_EQ(gltf.mesh.faces, glb.mesh.faces);
  EXPECT_TRUE(glb.notes.empty() && gltf.notes.empty());
}

TEST(Gltf, ReadsNormalizedAndPlainIntegers) {
  GltfFile file = triangle_file();
  file.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
      file.add_accessor<std::uint8_t>({255, 0, 51, 0, 255, 51, 0, 0, 255}, 5121, "VEC3", true);
  file.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
      file.add_accessor<std::uint16_t>({0, 0, 65535, 13107, 0, 65535}, 5123, "VEC2", true);
  file.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
      file.add_accessor<std::int8_t>({0, 0, 127, 0, 0, -128, 90, 0, 90}, 5120, "VEC3", true);
  file.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] =
      file.add_accessor<std::int16_t>({-5, 0, 0, 300, 0, 0, 0, 7, 0}, 5122, "VEC3", false);
  file.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  const Mesh mesh = read(file.glb()).mesh;
  EXPECT_EQ(mesh.positions, (std::vector<Vec3>{{-5, 0, 0}, {300, 0, 0}, {0, 7, 0}}));
  EXPECT_EQ(mesh.colors.values, (std::vector<Vec4>{{1, 0, 0.2f, 1}, {0, 1, 0.2f, 1}, {0, 0, 1, 1}}));
  EXPECT_EQ(mesh.uvs.values[0], Vec2(0, 1)) << "v points down in glTF, up here";
  EXPECT_EQ(mesh.uvs.values[1], Vec2(1, 1.0f - 0.2f));
  EXPECT_EQ(mesh.normals.values[1], Vec3(0, 0, -1));
  EXPECT_NEAR(mesh.normals.values[2].x, std::sqrt(0.5), 1e-6);
}

TEST(Gltf, ReadsStridesOffsetsAndSparseValues) {
  GltfFile file = triangle_file();
  // Elements of 12 bytes, 16 apart, behind 4 bytes of something else.
  const std::size_t begin = file.bin.size();
  file.append<float>({9, 0, 0, 1, 9, 2, 0, 1, 9, 0, 2, 1, 9});
  file.json["bufferViews"].push_back(
      {{"buffer", 0}, {"byteOffset", begin}, {"byteLength", file.bin.size() - begin}, {"byteStride", 16}});
  file.json["accessors"][0]["bufferView"] = file.json["bufferViews"].size() - 1;
  file.json["accessors"][0]["byteOffset"] = 4;
  EXPECT_EQ(read(file.glb()).mesh.positions, (std::vector<Vec3>{{0, 0, 1}, {2, 0, 1}, {0, 2, 1}}));
  const std::size_t indices = file.add_view<std::uint8_t>({1});
  const std::size_t values = file.add_view<float>({7, 8, 9});
  file.json["accessors"][0]["sparse"] = {{"count", 1},
                                         {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                                         {"values", {{"bufferView", values}}}};
  EXPECT_EQ(read(file.glb()).mesh.positions, (std::vector<Vec3>{{0, 0, 1}, {7, 8, 9}, {0, 2, 1}}));
  file.json["accessors"][0].erase("bufferView");
  file.json["accessors"][0].erase("byteOffset");
  EXPECT_EQ(read(file.glb()).mesh.positions, (std::vector<Vec3>{{0, 0, 0}, {7, 8, 9}, {0, 0, 0}}));
}

TEST(Gltf, ReadsEveryIndexType) {
  for (const int type : {5121, 5123, 5125}) {
    GltfFile file = triangle_file();
    const std::size_t accessor = type == 5121   ? file.add_accessor<std::uint8_t>({2, 0, 1}, type, "SCALAR")
                                 : type == 5123 ? file.add_accessor<std::uint16_t>({2, 0, 1}, type, "SCALAR")
                                                : file.add_accessor<std::uint32_t>({2, 0, 1}, type, "SCALAR");
    file.json["meshes"][0]["primitives"][0]["indices"] = accessor;
    EXPECT_EQ(read(file.glb()).mesh.faces, (std::vector<Triangle>{{2, 0, 1}})) << type;
  }
}

TEST(Gltf, TurnsStripsAndFansIntoTriangles) {
  GltfFile file = triangle_file();
  auto& primitive = file.json["meshes"][0]["primitives"][0];
  primitive["attributes"]["POSITION"] =
      file.add_accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0}, 5126, "VEC3");
  primitive.erase("indices");
  primitive["mode"] = 5;
  EXPECT_EQ(read(file.glb()).mesh.faces, (std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}}));
  primitive["mode"] = 6;
  EXPECT_EQ(read(file.glb()).mesh.faces, (std::vector<Triangle>{{1, 2, 0}, {2, 3, 0}, {3, 4, 0}}));
  primitive["mode"] = 5;
  primitive["indices"] = file.add_accessor<std::uint8_t>({0, 1, 2, 2, 3, 4}, 5121, "SCALAR");
  EXPECT_EQ(read(file.glb()).mesh.faces, (std::vector<Triangle>{{0, 1, 2}, {2, 4, 3}})) << "stitches are no surface";
  primitive["mode"] = 1;
  const ImportedMesh lines = read(file.glb());
  EXPECT_TRUE(lines.mesh.faces.empty());
  EXPECT_TRUE(has_note(lines, "points or lines"));
}

TEST(Gltf, AppliesTheTransformsOfNestedNodes) {
  GltfFile file = triangle_file();
  file.add_normals();
  file.json["nodes"] = Json::parse(R"([{"children":[1],"translation":[10,0,0]},
      {"mesh":0,"rotation":[0,0,0.7071067811865476,0.7071067811865476],"scale":[1,2,3]}])");
  const ImportedMesh imported = read(file.glb());
  ASSERT_EQ(imported.mesh.positions.size(), 3u);
  const Vec3 expected[] = {{10, 0, 0}, {10, 1, 0}, {8, 0, 0}};
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(glm::length(imported.mesh.positions[i] - expected[i]), 0.0f, 1e-6f) << i;
  EXPECT_EQ(imported.mesh.normals.values[0], Vec3(0, 0, 1));
  EXPECT_TRUE(has_note(imported, "node transforms"));
}

TEST(Gltf, NormalsStayPerpendicularAndMirroredFacesKeepTheirFront) {
  GltfFile file = triangle_file();
  file.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] =
      file.add_accessor<float>({1, 0, 0, 0, 1, 0, 0, 0, 1}, 5126, "VEC3");
  const float n = std::sqrt(1.0f / 3.0f);
  file.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
      file.add_accessor<float>({n, n, n, n, n, n, n, n, n}, 5126, "VEC3");
  for (const auto& scale : {std::array{2.0, 0.5, 3.0}, std::array{-2.0, 0.5, 3.0}, std::array{-1.0, -1.0, -1.0}}) {
    file.json["nodes"][0]["scale"] = scale;
    const Mesh mesh = read(file.glb()).mesh;
    const Triangle& t = mesh.faces.at(0);
    const Vec3 geometric = glm::normalize(
        glm::cross(mesh.positions[t[1]] - mesh.positions[t[0]], mesh.positions[t[2]] - mesh.positions[t[0]]));
    for (const Vec3& normal : mesh.normals.values)
      EXPECT_GT(glm::dot(geometric, normal), 0.99999f) << scale[0];
  }
}

TEST(Gltf, StoredBitsPassThroughAnIdentityTransform) {
  GltfFile file = triangle_file();
  const float odd = std::numeric_limits<float>::denorm_min();
  file.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] =
      file.add_accessor<float>({-0.0f, odd, 0.1f, 1, 0, 0, 0, 1, 0}, 5126, "VEC3");
  file.json["nodes"][0]["scale"] = {1, 1, 1};
  EXPECT_EQ(bits(read(file.glb()).mesh.positions.at(0)), bits(Vec3(-0.0f, odd, 0.1f)));
}

TEST(Gltf, ChoosesTheScene) {
  GltfFile file = triangle_file();
  file.json["nodes"] = Json::parse(
      R"([{"mesh":0,"translation":[1,0,0]},{"mesh":0,"translation":[2,0,0]},{"mesh":0,"translation":[3,0,0]}])");
  file.json["scenes"] = Json::parse(R"([{"nodes":[0]},{"nodes":[1,0]}])");
  file.json["scene"] = 1;
  const auto first_x = [&file] {
    std::vector<float> x;
    const Mesh mesh = read(file.glb()).mesh;
    for (std::size_t i = 0; i < mesh.positions.size(); i += 3)
      x.push_back(mesh.positions[i].x);
    return x;
  };
  EXPECT_EQ(first_x(), (std::vector<float>{2, 1}));
  file.json.erase("scene");
  EXPECT_EQ(first_x(), (std::vector<float>{1, 2})) << "the roots of all scenes, each once";
  file.json.erase("scenes");
  EXPECT_EQ(first_x(), (std::vector<float>{1, 2, 3})) << "all nodes";
  file.json.erase("nodes");
  EXPECT_EQ(first_x(), (std::vector<float>{0})) << "every mesh once";
}

TEST(Gltf, SharesTheVerticesOfPrimitivesWithTheSameAccessors) {
  GltfFile file = triangle_file();
  auto& primitives = file.json["meshes"][0]["primitives"];
  primitives.push_back(primitives[0]);
  const Mesh mesh = read(file.glb()).mesh;
  EXPECT_EQ(mesh.positions.size(), 3u);
  EXPECT_EQ(mesh.faces.size(), 2u);
}

TEST(Gltf, FillsAttributesThatSomePrimitivesLack) {
  GltfFile file = triangle_file();
  auto& primitives = file.json["meshes"][0]["primitives"];
  Json bare = primitives[0];
  file.add_normals({1, 0, 0});
  primitives[0]["attributes"]["TEXCOORD_0"] = file.add_accessor<float>({1, 1, 1, 1, 1, 1}, 5126, "VEC2");
  primitives[0]["attributes"]["COLOR_0"] = file.add_accessor<float>({0, 0, 0, 0, 0, 0, 0, 0, 0}, 5126, "VEC3");
  primitives.push_back(bare);
  primitives.insert(primitives.begin(), bare);
  file.json["materials"] = Json::parse(R"([{"name":"only"}])");
  primitives[2]["material"] = 0;
  const ImportedMesh imported = read(file.glb());
  const Mesh& mesh = imported.mesh;
  ASSERT_EQ(mesh.faces.size(), 3u);
  EXPECT_EQ(mesh.corner(mesh.normals, 0, 1), Vec3(0, 0, 1));
  EXPECT_EQ(mesh.corner(mesh.normals, 1, 1), Vec3(1, 0, 0));
  EXPECT_EQ(mesh.corner(mesh.normals, 2, 1), Vec3(0, 0, 1));
  EXPECT_EQ(mesh.corner(mesh.uvs, 0, 0), Vec2(0, 0));
  EXPECT_EQ(mesh.corner(mesh.uvs, 1, 0), Vec2(1, 0));
  EXPECT_EQ(mesh.corner(mesh.colors, 2, 0), Vec4(1, 1, 1, 1));
  EXPECT_EQ(mesh.corner(mesh.colors, 1, 0), Vec4(0, 0, 0, 1));
  EXPECT_EQ(mesh.face_materials, (std::vector<std::uint32_t>{1, 1, 0}));
  EXPECT_EQ(mesh.materials.at(1).metallic, 1.0f) << "the default material of glTF";
  for (const char* part : {"2 faces without normals", "without texture coordinates", "without a colour"}) {
    EXPECT_TRUE(has_note(imported, part)) << part;
  }
}

TEST(Gltf, NamesWhatItLeavesOut) {
  GltfFile file = triangle_file();
  auto& primitive = file.json["meshes"][0]["primitives"][0];
  primitive["attributes"]["TANGENT"] = 0;
  primitive["targets"] = Json::parse(R"([{"POSITION":0}])");
  file.json["skins"] = Json::parse(R"([{"joints":[0]}])");
  file.json["animations"] = Json::parse("[{},{}]");
  file.json["nodes"][0]["skin"] = 0;
  file.json["nodes"][0]["translation"] = {5, 5, 5};
  file.json["extensionsUsed"] = {"KHR_lights_punctual"};
  const ImportedMesh imported = read(file.glb() + "tail");
  for (const char* part : {"attributes left out: TANGENT", "morph targets of 1", "1 skins", "2 animations",
                           "KHR_lights_punctual", "4 bytes after the end"}) {
    EXPECT_TRUE(has_note(imported, part)) << part;
  }
  EXPECT_EQ(imported.mesh.positions[0], Vec3(0, 0, 0)) << "a skinned mesh stays where it is stored";
}

TEST(Gltf, ReadsMaterialsAndPictures) {
  const test::TempFolder folder;
  folder.write("skin 1.png", test::kTinyPng);
  GltfFile file = triangle_file();
  auto& json = file.json;
  json["materials"] =
      Json::parse(R"([{"name":"m","doubleSided":true,"pbrMetallicRoughness":{"baseColorFactor":[0.1,0.2,0.3,0.4],
      "metallicFactor":0.5,"roughnessFactor":0.25,"baseColorTexture":{"index":0}}},{"pbrMetallicRoughness":{"baseColorTexture":{"index":1}}},
      {"pbrMetallicRoughness":{"baseColorTexture":{"index":2}}}])");
  json["textures"] = Json::parse(R"([{"source":0},{"source":1},{"source":2}])");
  json["images"] =
      Json::parse(R"([{"uri":"skin%201.png"},{"uri":"lost.png"},{"uri":"data:image/webp;base64,UklGRg=="}])");
  json["meshes"][0]["primitives"][0]["material"] = 0;
  const ImportedMesh imported = read(file.glb(), folder.path());
  ASSERT_EQ(imported.mesh.materials.size(), 3u);
  const Material& material = imported.mesh.materials[0];
  EXPECT_EQ(material.name, "m");
  EXPECT_EQ(material.base_color, Vec4(0.1f, 0.2f, 0.3f, 0.4f));
  EXPECT_EQ(material.metallic, 0.5f);
  EXPECT_EQ(material.roughness, 0.25f);
  EXPECT_TRUE(material.double_sided);
  EXPECT_EQ(material.base_color_image.size(), test::kTinyPng.size());
  EXPECT_EQ(material.base_color_image_mime, "image/png");
  EXPECT_TRUE(imported.mesh.materials[1].base_color_image.empty());
  EXPECT_TRUE(has_note(imported, "\"lost.png\" left out: no such file"));
  EXPECT_TRUE(has_note(imported, "images[2] left out: neither PNG nor JPEG"));
}

TEST(Gltf, ReadsNormalMapsWithTheirScale) {
  const test::TempFolder folder;
  folder.write("n.png", test::kTinyPng);
  GltfFile file = triangle_file();
  auto& json = file.json;
  json["materials"] = Json::parse(R"([{"normalTexture":{"index":0,"scale":0.25}},{"normalTexture":{"index":0}},
      {"normalTexture":{"index":0,"texCoord":1,"scale":3}},{"normalTexture":{"index":0,"scale":1e300}},{}])");
  json["textures"] = Json::parse(R"([{"source":0}])");
  json["images"] = Json::parse(R"([{"uri":"n.png"}])");
  const ImportedMesh imported = read(file.glb(), folder.path());
  const std::vector<Material>& materials = imported.mesh.materials;
  ASSERT_GE(materials.size(), 5u);
  EXPECT_EQ(materials[0].normal_image.size(), test::kTinyPng.size());
  EXPECT_EQ(materials[0].normal_image_mime, "image/png");
  EXPECT_EQ(materials[0].normal_scale, 0.25f);
  EXPECT_TRUE(materials[0].base_color_image.empty());
  EXPECT_EQ(materials[1].normal_scale, 1.0f);
  EXPECT_TRUE(materials[2].normal_image.empty());
  EXPECT_EQ(materials[2].normal_scale, 1.0f);
  EXPECT_TRUE(has_note(imported, "materials[2].normalTexture left out: it uses other texture coordinates"));
  EXPECT_TRUE(std::isfinite(materials[3].normal_scale));
  EXPECT_TRUE(materials[4].normal_image.empty());
}

TEST(Gltf, RefusesANormalTextureThatIsNotThere) {
  GltfFile file = triangle_file();
  file.json["materials"] = Json::parse(R"([{"normalTexture":{"index":7}}])");
  const auto imported = formats::read_gltf(source_of(file.glb(), {}));
  ASSERT_FALSE(imported);
  EXPECT_NE(format_error(imported.error()).find("materials[0].normalTexture.index"), std::string::npos)
      << format_error(imported.error());
}

Mesh random_mesh(bool attributes) {
  Random random(5);
  Mesh mesh;
  for (int i = 0; i < 300; ++i) {
    mesh.positions.emplace_back(random.uniform(-1e6, 1e6), random.uniform(-1, 1), random.uniform(-1e-6, 1e-6));
    if (attributes) {
      mesh.normals.values.push_back(random.direction());
      mesh.uvs.values.emplace_back(static_cast<float>(random.below(257)) / 256.0f,
                                   static_cast<float>(random.below(257)) / 256.0f);
      mesh.colors.values.emplace_back(random.uniform(), random.uniform(), random.uniform(), 1.0f);
    }
  }
  mesh.positions[0] = {-0.0f, std::numeric_limits<float>::denorm_min(), std::numeric_limits<float>::max()};
  for (std::uint32_t i = 0; i + 2 < 300; i += 3)
    mesh.faces.push_back({i, i + 1, i + 2});
  return mesh;
}

TEST(GltfWrite, RoundTripKeepsPositionsBitForBit) {
  for (const bool attributes : {false, true}) {
    for (const bool binary : {false, true}) {
      const Mesh mesh = random_mesh(attributes);
      const auto files = write_gltf(mesh, "m.glb", binary);
      ASSERT_TRUE(files.has_value());
      ASSERT_EQ(files->size(), 1u);
      const ImportedMesh back = read((*files)[0].bytes);
      EXPECT_TRUE(back.notes.empty());
      ASSERT_EQ(back.mesh.positions.size(), mesh.positions.size());
      for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        ASSERT_EQ(bits(back.mesh.positions[i]), bits(mesh.positions[i])) << i;
      EXPECT_EQ(back.mesh.faces, mesh.faces);
      EXPECT_EQ(back.mesh.normals.values, mesh.normals.values);
      EXPECT_EQ(back.mesh.uvs.values, mesh.uvs.values);
      EXPECT_EQ(back.mesh.colors.values, mesh.colors.values);
      EXPECT_EQ((*files)[0].bytes, (*write_gltf(mesh, "m.glb", binary))[0].bytes) << "same mesh, same bytes";
    }
  }
}

TEST(GltfWrite, MaterialsSurviveAndShareVertices) {
  Mesh mesh = random_mesh(true);
  mesh.materials.resize(3);
  mesh.materials[0].name = "first \"quoted\"";
  mesh.materials[1].base_color = {0.25f, 0.5f, 0.75f, 0.5f};
  mesh.materials[1].double_sided = true;
  const auto png = std::as_bytes(std::span(test::kTinyPng.data(), test::kTinyPng.size()));
  mesh.materials[2].base_color_image.assign(png.begin(), png.end());
  mesh.materials[2].base_color_image_mime = "image/png";
  mesh.materials[2].metallic = 0.3f;
  mesh.materials[1].normal_image = mesh.materials[2].base_color_image;
  mesh.materials[1].normal_image_mime = "image/png";
  mesh.materials[1].normal_scale = 0.5f;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    mesh.face_materials.push_back(f < 40 ? 2 : f % 2);
  const auto files = write_gltf(mesh, "m.gltf", false);
  ASSERT_TRUE(files.has_value());
  const Mesh back = read((*files)[0].bytes).mesh;
  EXPECT_EQ(back.positions, mesh.positions);
  ASSERT_EQ(back.materials.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(back.materials[i].name, mesh.materials[i].name);
    EXPECT_EQ(back.materials[i].base_color, mesh.materials[i].base_color);
    EXPECT_EQ(back.materials[i].metallic, mesh.materials[i].metallic);
    EXPECT_EQ(back.materials[i].roughness, mesh.materials[i].roughness);
    EXPECT_EQ(back.materials[i].double_sided, mesh.materials[i].double_sided);
    EXPECT_EQ(back.materials[i].base_color_image, mesh.materials[i].base_color_image);
    EXPECT_EQ(back.materials[i].normal_image, mesh.materials[i].normal_image);
    EXPECT_EQ(back.materials[i].normal_image_mime, mesh.materials[i].normal_image_mime);
    EXPECT_EQ(back.materials[i].normal_scale, mesh.materials[i].normal_scale);
  }
  // Faces come back grouped by material: the same triangles, each with its own.
  std::vector<std::pair<Triangle, std::uint32_t>> before, after;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    before.emplace_back(mesh.faces[f], mesh.face_materials[f]);
    after.emplace_back(back.faces.at(f), back.face_materials.at(f));
  }
  std::sort(before.begin(), before.end());
  std::sort(after.begin(), after.end());
  EXPECT_EQ(before, after);
}

TEST(GltfWrite, MaterialsSurviveObjToGlbToObj) {
  const std::string mtl =
      "newmtl a b\nKd 0.1 0.2 0.3\nd 0.4\nPr 0.5\nPm 0.7\nmap_Kd p.png\nnewmtl c\nKd 1 0 0\nnorm p.png\n";
  const std::string obj =
      "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nusemtl a b\nf 1/1 2/1 3/1\nusemtl c\nf 2/1 4/1 3/1\n";
  const test::TempFolder first, last;
  first.write("m.mtl", mtl);
  first.write("p.png", test::kTinyPng);
  const auto from_obj = formats::read_obj(source_of(obj, first.path()));
  ASSERT_TRUE(from_obj.has_value());
  const auto glb = write_gltf(from_obj->mesh, "m.glb", true);
  const Mesh from_glb = read((*glb)[0].bytes).mesh;
  const auto files = formats::write_obj(from_glb, last / "n.obj");
  ASSERT_TRUE(files.has_value());
  for (const auto& file : *files)
    last.write(file.path.filename().string(), file.bytes);
  const std::string text = test::slurp(last / "n.obj");
  const auto back = formats::read_obj(source_of(text, last.path()));
  ASSERT_TRUE(back.has_value());
  ASSERT_EQ(back->mesh.materials.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    const Material& was = from_obj->mesh.materials[i];
    const Material& is = back->mesh.materials[i];
    EXPECT_EQ(is.name, was.name);
    EXPECT_EQ(is.base_color, was.base_color);
    EXPECT_EQ(is.roughness, was.roughness);
    EXPECT_EQ(is.metallic, was.metallic);
    EXPECT_EQ(is.base_color_image, was.base_color_image);
    EXPECT_EQ(is.normal_image, was.normal_image);
    EXPECT_EQ(is.normal_image.empty(), i == 0);
  }
  EXPECT_EQ(back->mesh.face_materials, from_obj->mesh.face_materials);
  EXPECT_EQ(back->mesh.positions, from_obj->mesh.positions);
}

TEST(GltfWrite, UsesWideIndicesOnlyWhenNeeded) {
  for (const std::size_t count : {std::size_t{65535}, std::size_t{65536}}) {
    Mesh mesh;
    mesh.positions.resize(count, Vec3(1.0f));
    mesh.faces = {{0, 1, static_cast<VertexId>(count - 1)}};
    const auto files = write_gltf(mesh, "m.glb", true);
    ASSERT_TRUE(files.has_value());
    EXPECT_EQ((*files)[0].bytes.find("5125") != std::string::npos, count > 65535);
    EXPECT_EQ(read((*files)[0].bytes).mesh.faces, mesh.faces);
  }
}

TEST(GltfWrite, AMeshWithoutFacesIsAnEmptyScene) {
  Mesh mesh;
  mesh.positions.resize(3);
  const auto files = write_gltf(mesh, "m.gltf", false);
  ASSERT_TRUE(files.has_value());
  EXPECT_TRUE(read((*files)[0].bytes).mesh.faces.empty());
}

TEST(GltfWrite, RefusesWhatCannotBeWritten) {
  Mesh mesh = random_mesh(false);
  mesh.positions[7].z = std::numeric_limits<float>::infinity();
  EXPECT_EQ(write_gltf(mesh, "m.glb", true).error().where, "vertex 7");
  mesh.positions[7].z = 0.0f;
  mesh.materials.resize(1);
  mesh.face_materials.assign(mesh.faces.size(), 1);
  EXPECT_EQ(write_gltf(mesh, "m.glb", true).error().code, ErrorCode::kInvalidArgument);
}

}  // namespace
}  // namespace limn
