#include <algorithm>
#include <gtest/gtest.h>

#include "support/mesh_source.h"
#include "support/temp_folder.h"

namespace limn {
namespace {

constexpr std::string_view kCollada = R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="1" name="meter"/><up_axis>Y_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="12">0 0 0 1 0 0 1 1 0 0 1 0.5</float_array>
<technique_common><accessor source="#pa" count="4" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<polylist count="1"><input semantic="VERTEX" source="#v" offset="0"/><vcount>4</vcount><p>0 1 2 3</p></polylist>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node><translate>10 0 0</translate><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";

formats::Source named(std::string_view text, std::string name, std::filesystem::path folder = {}) {
  formats::Source source = test::source_of(text, std::move(folder));
  source.name = std::move(name);
  return source;
}

#ifdef LIMN_TEST_ASSIMP
TEST(Assimp, ReadsColladaFromMemory) {
  const Result<ImportedMesh> result = formats::read_other(named(kCollada, "quad.DAE"));
  ASSERT_TRUE(result.has_value()) << format_error(result.error());
  EXPECT_EQ(result->format, MeshFormat::kOther);
  EXPECT_EQ(result->mesh.faces.size(), 2u);
  for (const Vec3& p : result->mesh.positions)
    EXPECT_GE(p.x, 10.0f) << "the node's translation was lost";
  ASSERT_FALSE(result->notes.empty());
  EXPECT_NE(result->notes[0].find("assimp"), std::string::npos);
}

TEST(Assimp, OpensNoOtherFile) {
  // An .obj handed to assimp names a library beside it that would change the material's colour.
  const test::TempFolder folder;
  folder.write("beside.mtl", "newmtl a\nKd 0.5 0.25 0.125\n");
  const std::string text = "mtllib beside.mtl\nmtllib " + (folder / "beside.mtl").string() +
                           "\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n";
  const Result<ImportedMesh> result = formats::read_other(named(text, (folder / "m.obj").string(), folder.path()));
  ASSERT_TRUE(result.has_value()) << format_error(result.error());
  for (const Material& material : result->mesh.materials)
    EXPECT_NE(material.base_color.r, 0.5f) << "the library was read";
  EXPECT_TRUE(std::any_of(result->notes.begin(), result->notes.end(),
                          [](const std::string& note) { return note.find("not read") != std::string::npos; }));
}

TEST(Assimp, BrokenFilesAreErrors) {
  for (std::size_t length = 0; length < kCollada.size(); length += 97) {
    const Result<ImportedMesh> result = formats::read_other(named(kCollada.substr(0, length), "quad.dae"));
    ASSERT_FALSE(result.has_value()) << length;
    EXPECT_EQ(result.error().code, ErrorCode::kUnreadable);
    EXPECT_FALSE(result.error().message.empty());
  }
  EXPECT_FALSE(formats::read_other(named("no model", "m.nonsense")).has_value());
}
#else
TEST(Assimp, SaysThatItIsMissing) {
  const Result<ImportedMesh> result = formats::read_other(named(kCollada, "quad.dae"));
  ASSERT_FALSE(result.has_value());
  EXPECT_EQ(result.error().code, ErrorCode::kUnreadable);
  EXPECT_FALSE(result.error().remedy.empty());
}
#endif

}  // namespace
}  // namespace limn
