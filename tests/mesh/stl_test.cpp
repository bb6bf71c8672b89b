#include <gtest/gtest.h>
#include <string>

#include "limn/mesh/formats/formats.h"

#include "support/mesh_bits.h"
#include "support/stable.h"

namespace limn {
namespace {

using test::append_bytes;
using test::corner_positions;
using test::must_read;
using test::same_bits;

std::string written(const Mesh& mesh, bool ascii) {
  return formats::write_stl(mesh, "out.stl", ascii)->front().bytes;
}

const std::string kFacet =
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";

std::string binary_with_title(std::string title, std::uint32_t facets, std::uint16_t attribute = 0) {
  title.resize(80, ' ');
  append_bytes(title, facets);
  for (std::uint32_t i = 0; i < facets; ++i) {
    for (int k = 0; k < 12; ++k)
      append_bytes(title, static_cast<float>(k));
    append_bytes(title, attribute);
  }
  return title;
}

TEST(Stl, KeepsEveryBitOfPositionsBothWays) {
  for (const bool ascii : {false, true}) {
    const Mesh mesh = test::awkward_tetrahedron(true);
    const ImportedMesh back = must_read(written(mesh, ascii), MeshFormat::kStl);
    EXPECT_TRUE(back.notes.empty());
    EXPECT_TRUE(same_bits(corner_positions(mesh), corner_positions(back.mesh)));
    EXPECT_TRUE(back.mesh.normals.empty());
    for (const test::StableMesh& entry : test::awkward_meshes()) {
      SCOPED_TRACE(entry.name);
      EXPECT_TRUE(same_bits(corner_positions(entry.mesh),
                            corner_positions(must_read(written(entry.mesh, ascii), MeshFormat::kStl).mesh)));
    }
  }
}

TEST(Stl, TellsBinaryFilesThatBeginWithSolidFromText) {
  EXPECT_EQ(must_read(binary_with_title("solid facet by some program", 2), MeshFormat::kStl).mesh.faces.size(), 2u);
  EXPECT_EQ(must_read("  solid facet\n" + kFacet + "endsolid\n", MeshFormat::kStl).mesh.faces.size(), 1u);
}

TEST(Stl, JoinsSeveralSolids) {
  const ImportedMesh imported =
      must_read("solid a\n" + kFacet + "endsolid a\nSOLID b\n" + kFacet + kFacet + "ENDSOLID b\n", MeshFormat::kStl);
  EXPECT_EQ(imported.mesh.faces.size(), 3u);
  EXPECT_EQ(imported.notes, std::vector<std::string>{"2 solids joined into one mesh"});
}

TEST(Stl, ReadsTextOnOneLineAndNamelessNormals) {
  std::string line = "solid x\n" + kFacet + kFacet + "endsolid x\n";
  std::replace(line.begin() + 8, line.end(), '\n', ' ');
  EXPECT_EQ(must_read(line, MeshFormat::kStl).mesh.faces.size(), 2u);
  EXPECT_EQ(must_read("solid\nfacet normal nan nan nan\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
                      "endfacet\nendsolid\n",
                      MeshFormat::kStl)
                .mesh.faces.size(),
            1u);
}

TEST(Stl, NotesAttributesAndTrailingBytes) {
  const ImportedMesh imported = must_read(binary_with_title("x", 1, 7) + "tail", MeshFormat::kStl);
  ASSERT_EQ(imported.notes.size(), 2u);
  EXPECT_EQ(imported.notes[1], "4 bytes behind the last facet left out");
}

TEST(Stl, WritesNormalsOfTheWinding) {
  Mesh mesh;
  mesh.positions = {Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(0, 3, 0)};
  mesh.faces = {{0, 1, 2}, {0, 2, 1}};
  const std::string text = written(mesh, true);
  EXPECT_NE(text.find("facet normal 0 0 1\n"), std::string::npos);
  EXPECT_NE(text.find("facet normal 0 0 -1\n"), std::string::npos);
  EXPECT_FALSE(written(mesh, false).starts_with("solid"));
}

}  // namespace
}  // namespace limn
