#include <gtest/gtest.h>
#include <string>

#include "limn/mesh/formats/color.h"
#include "limn/mesh/formats/formats.h"

#include "support/mesh_bits.h"
#include "support/stable.h"

namespace limn {
namespace {

using test::corner_positions;
using test::must_read;
using test::same_bits;

TEST(Off, KeepsEveryBitOfPositions) {
  const Mesh mesh = test::awkward_tetrahedron(true);
  const ImportedMesh back = must_read(formats::write_off(mesh, "out.off")->front().bytes, MeshFormat::kOff);
  EXPECT_TRUE(back.notes.empty());
  EXPECT_TRUE(same_bits(mesh.positions, back.mesh.positions));
  EXPECT_EQ(mesh.faces, back.mesh.faces);
  for (const test::StableMesh& entry : test::awkward_meshes()) {
    SCOPED_TRACE(entry.name);
    const std::string text = formats::write_off(entry.mesh, "out.off")->front().bytes;
    EXPECT_TRUE(same_bits(entry.mesh.positions, must_read(text, MeshFormat::kOff).mesh.positions));
  }
}

TEST(Off, ReadsCommentsPolygonsAndCountsOnTheirOwnTerms) {
  const ImportedMesh imported = must_read(
      "# a comment\nOFF # keyword\n\n4 2 # no edges\n0 0 0\n1 0 0 # corner\n\n1 1 0\n0 1 0\n4 0 1 2 3 255 0 0\n3 0 1 "
      "2\n",
      MeshFormat::kOff);
  EXPECT_EQ(imported.mesh.faces, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 1, 2}}));
  ASSERT_EQ(imported.notes.size(), 2u);
  EXPECT_EQ(imported.notes[1], "colours of 1 faces left out");
}

TEST(Off, ReadsCountsGluedToTheKeywordOrWithoutOne) {
  EXPECT_EQ(must_read("OFF3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", MeshFormat::kOff).mesh.faces.size(), 1u);
  EXPECT_EQ(must_read("OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", MeshFormat::kOff).mesh.faces.size(), 1u);
  EXPECT_EQ(must_read("3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", MeshFormat::kOff).mesh.faces.size(), 1u);
}

TEST(Off, ReadsEveryPrefix) {
  const ImportedMesh all = must_read("STCNOFF\n1 0 0\n1 2 3  0 0 1  0 0.5 1 0.25  0.75 0.125\n", MeshFormat::kOff);
  EXPECT_EQ(all.mesh.positions.at(0), Vec3(1, 2, 3));
  EXPECT_EQ(all.mesh.normals.values.at(0), Vec3(0, 0, 1));
  EXPECT_EQ(all.mesh.colors.values.at(0), Vec4(0, 0.5f, 1, 0.25f));
  EXPECT_EQ(all.mesh.uvs.values.at(0), Vec2(0.75f, 0.125f));
  const ImportedMesh bytes = must_read("COFF\n2 0 0\n0 0 0 255 128 0\n0 0 0 1 0 0 51\n", MeshFormat::kOff);
  EXPECT_EQ(bytes.mesh.colors.values.at(0), Vec4(1, formats::linear_of_srgb_byte()[128], 0, 1));
  EXPECT_EQ(bytes.mesh.colors.values.at(1).a, 0.2f);
  EXPECT_EQ(must_read("NOFF\n1 0 0\n0 0 0 0 1 0\n", MeshFormat::kOff).mesh.normals.values.at(0), Vec3(0, 1, 0));
}

TEST(Off, TextureCoordinatesDoNotTellWhetherColorsAreBytes) {
  for (const char* const keyword : {"STCOFF", "STCNOFF"}) {
    const std::string normal = keyword == std::string_view("STCNOFF") ? " 0 0 1 " : " ";
    const auto read_vertex = [&](const std::string& extras) {
      return must_read(std::string(keyword) + "\n1 0 0\n1 2 3" + normal + extras + "\n", MeshFormat::kOff).mesh;
    };
    const Mesh repeated = read_vertex("0.5 0.25 0.75 2.5 -3");
    EXPECT_EQ(repeated.colors.values.at(0), Vec4(0.5f, 0.25f, 0.75f, 1)) << keyword;
    EXPECT_EQ(repeated.uvs.values.at(0), Vec2(2.5f, -3)) << keyword;
    EXPECT_EQ(read_vertex("0.5 0.25 0.75 0.125 2.5 7").colors.values.at(0), Vec4(0.5f, 0.25f, 0.75f, 0.125f));
    EXPECT_EQ(read_vertex("255 0 0 0.5 0.5").colors.values.at(0), Vec4(1, 0, 0, 1)) << keyword;
  }
}

}  // namespace
}  // namespace limn
