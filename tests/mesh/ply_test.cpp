#include <cmath>
#include <gtest/gtest.h>
#include <string>

#include "limn/mesh/formats/color.h"
#include "limn/mesh/formats/formats.h"

#include "support/mesh_bits.h"
#include "support/stable.h"

namespace limn {
namespace {

using test::append_bytes;
using test::corner_positions;
using test::corner_values;
using test::must_read;
using test::same_bits;

std::string written(const Mesh& mesh, bool ascii) {
  const auto files = formats::write_ply(mesh, "out.ply", ascii);
  EXPECT_TRUE(files);
  return files->front().bytes;
}

void expect_same_corners(const Mesh& a, const Mesh& b) {
  EXPECT_TRUE(same_bits(corner_positions(a), corner_positions(b)));
  EXPECT_TRUE(same_bits(corner_values(a, a.normals), corner_values(b, b.normals)));
  EXPECT_TRUE(same_bits(corner_values(a, a.uvs), corner_values(b, b.uvs)));
  EXPECT_TRUE(same_bits(corner_values(a, a.colors), corner_values(b, b.colors)));
}

TEST(Ply, KeepsEveryBitBothWays) {
  for (const bool ascii : {false, true}) {
    for (const bool seams : {false, true}) {
      const Mesh mesh = test::awkward_tetrahedron(seams);
      const ImportedMesh back = must_read(written(mesh, ascii), MeshFormat::kPly);
      EXPECT_TRUE(back.notes.empty()) << back.notes.front();
      expect_same_corners(mesh, back.mesh);
      std::vector<float> tags;
      for (const Triangle& face : mesh.faces) {
        for (const VertexId v : face)
          tags.push_back(mesh.tags[v]);
      }
      std::vector<float> tags_back;
      for (const Triangle& face : back.mesh.faces) {
        for (const VertexId v : face)
          tags_back.push_back(back.mesh.tags[v]);
      }
      EXPECT_TRUE(same_bits(tags, tags_back));
    }
  }
}

TEST(Ply, KeepsTheStableOfAwkwardMeshes) {
  for (const test::StableMesh& entry : test::awkward_meshes()) {
    for (const bool ascii : {false, true}) {
      SCOPED_TRACE(entry.name);
      const ImportedMesh back = must_read(written(entry.mesh, ascii), MeshFormat::kPly);
      expect_same_corners(entry.mesh, back.mesh);
    }
  }
}

TEST(Ply, StoresByteColorsAsBytesAndOthersAsFloats) {
  Mesh mesh = test::awkward_tetrahedron(false);
  mesh.colors.values.clear();
  for (const int byte : {0, 1, 128, 255}) {
    const float linear = formats::linear_of_srgb_byte()[static_cast<std::size_t>(byte)];
    mesh.colors.values.emplace_back(linear, linear, linear, static_cast<float>(byte) / 255.0f);
  }
  const std::string bytes = written(mesh, false);
  EXPECT_NE(bytes.find("property uchar red"), std::string::npos);
  expect_same_corners(mesh, must_read(bytes, MeshFormat::kPly).mesh);
  mesh.colors.values[2].r = 0.5f;
  const std::string floats = written(mesh, false);
  EXPECT_NE(floats.find("property float red"), std::string::npos);
  expect_same_corners(mesh, must_read(floats, MeshFormat::kPly).mesh);
}

/// Every scalar type in some property, a list in the vertex, a foreign element in between, properties in any order.
std::string every_type(bool big_endian) {
  std::string file =
      std::string("ply\r\nformat ") + (big_endian ? "binary_big_endian" : "binary_little_endian") +
      " 1.0\r\ncomment made by hand\r\nobj_info nothing\r\n"
      "element vertex 4\r\nproperty uchar quality\r\nproperty double z\r\nproperty list ushort short extra\r\n"
      "property int16 y\r\nproperty float32 x\r\nproperty ushort red\r\nproperty uint8 green\r\n"
      "property char blue\r\nproperty uint32 tag\r\n"
      "element edge 2\r\nproperty int a\r\nproperty list uchar uint b\r\n"
      "element face 2\r\nproperty uchar flag\r\nproperty list int8 uint16 vertex_index\r\nend_header\r\n";
  for (int i = 0; i < 4; ++i) {
    append_bytes(file, std::uint8_t{7}, big_endian);
    append_bytes(file, 0.5 * i, big_endian);
    append_bytes(file, std::uint16_t{2}, big_endian);
    append_bytes(file, std::int16_t{-1}, big_endian);
    append_bytes(file, std::int16_t{-2}, big_endian);
    append_bytes(file, static_cast<std::int16_t>(i - 2), big_endian);
    append_bytes(file, static_cast<float>(i * i), big_endian);
    append_bytes(file, std::uint16_t{65535}, big_endian);
    append_bytes(file, std::uint8_t{255}, big_endian);
    append_bytes(file, std::int8_t{0}, big_endian);
    append_bytes(file, static_cast<std::uint32_t>(i), big_endian);
  }
  for (int i = 0; i < 2; ++i) {
    append_bytes(file, std::int32_t{9}, big_endian);
    append_bytes(file, std::uint8_t{1}, big_endian);
    append_bytes(file, std::uint32_t{9}, big_endian);
  }
  for (int i = 0; i < 2; ++i) {
    append_bytes(file, std::uint8_t{1}, big_endian);
    append_bytes(file, static_cast<std::int8_t>(3 + i), big_endian);
    for (int c = 0; c < 3 + i; ++c)
      append_bytes(file, static_cast<std::uint16_t>((c + i) % 4), big_endian);
  }
  return file;
}

TEST(Ply, ReadsAnyTypeOrderAndByteOrder) {
  for (const bool big_endian : {false, true}) {
    const ImportedMesh imported = must_read(every_type(big_endian), MeshFormat::kPly);
    const Mesh& mesh = imported.mesh;
    ASSERT_EQ(mesh.positions.size(), 4u);
    EXPECT_EQ(mesh.positions[3], Vec3(9, 1, 1.5f));
    EXPECT_EQ(mesh.faces, (std::vector<Triangle>{{0, 1, 2}, {1, 2, 3}, {1, 3, 0}}));
    EXPECT_EQ(mesh.tags, (std::vector<float>{0, 1, 2, 3}));
    EXPECT_EQ(mesh.colors.values[1], Vec4(1, 1, 0, 1));
    EXPECT_EQ(imported.notes.size(), 4u);  // two properties, the edges, the flag, the polygon
  }
}

TEST(Ply, BinaryWithoutListsReadsTheSameAsText) {
  const std::string properties =
      "property double x\nproperty double y\nproperty double z\nproperty uchar red\n"
      "property uchar green\nproperty uchar blue\nelement face 1\n"
      "property list uchar uint vertex_indices\nend_header\n";
  std::string text = "ply\nformat ascii 1.0\nelement vertex 1200\n" + properties;
  std::string big = "ply\nformat binary_big_endian 1.0\nelement vertex 1200\n" + properties;
  std::string little = "ply\nformat binary_little_endian 1.0\nelement vertex 1200\n" + properties;
  for (int i = 0; i < 1200; ++i) {
    const double value = std::sin(static_cast<double>(i));
    text += std::to_string(i) + " 0.5 -2e3 " + std::to_string(i % 256) + " 0 255\n";
    for (std::string* file : {&big, &little}) {
      const bool swapped = file == &big;
      for (const double number : {static_cast<double>(i), 0.5, -2e3})
        append_bytes(*file, number, swapped);
      for (const int number : {i % 256, 0, 255})
        append_bytes(*file, static_cast<std::uint8_t>(number), swapped);
    }
    static_cast<void>(value);
  }
  text += "3 0 1 1199\n";
  for (std::string* file : {&big, &little}) {
    append_bytes(*file, std::uint8_t{3});
    for (const std::uint32_t index : {0u, 1u, 1199u})
      append_bytes(*file, index, file == &big);
  }
  const Mesh a = must_read(text, MeshFormat::kPly).mesh;
  for (const std::string* file : {&big, &little}) {
    const Mesh b = must_read(*file, MeshFormat::kPly).mesh;
    EXPECT_TRUE(same_bits(a.positions, b.positions));
    EXPECT_TRUE(same_bits(a.colors.values, b.colors.values));
    EXPECT_EQ(a.faces, b.faces);
  }
}

const std::string kFourVertices =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
const std::string kFourPoints = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

TEST(Ply, CutsPolygonsIntoTrianglesAndCountsThem) {
  const ImportedMesh imported =
      must_read(kFourVertices + "element face 3\nproperty list uchar int vertex_indices\nend_header\n" + kFourPoints +
                    "4 0 1 2 3\n2 0 1\n3 3 2 1\n",
                MeshFormat::kPly);
  EXPECT_EQ(imported.mesh.faces, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {3, 2, 1}}));
  ASSERT_EQ(imported.notes.size(), 2u);
  EXPECT_EQ(imported.notes[0], "1 polygons cut into 2 triangles");
  EXPECT_EQ(imported.notes[1], "1 faces of fewer than three corners left out");
}

TEST(Ply, KeepsTextureCoordinatesByCorner) {
  const ImportedMesh imported = must_read(
      kFourVertices +
          "element face 2\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\nproperty int "
          "texnumber\nend_header\n" +
          kFourPoints + "4 0 1 2 3 8 0 0 .1 0 .2 .3 0 .4 0\n3 0 1 2 6 .5 .5 .6 .6 .7 .7 1\n",
      MeshFormat::kPly);
  const std::vector<Vec2> expected = {{0, 0},   {.1f, 0},   {.2f, .3f}, {0, 0},    {.2f, .3f},
                                      {0, .4f}, {.5f, .5f}, {.6f, .6f}, {.7f, .7f}};
  EXPECT_EQ(corner_values(imported.mesh, imported.mesh.uvs), expected);
}

TEST(Ply, UnrollsTriangleStrips) {
  const ImportedMesh imported =
      must_read(kFourVertices + "element tristrips 1\nproperty list int int vertex_indices\nend_header\n" +
                    kFourPoints + "8 0 1 2 3 -1 3 2 1\n",
                MeshFormat::kPly);
  EXPECT_EQ(imported.mesh.faces, (std::vector<Triangle>{{0, 1, 2}, {2, 1, 3}, {3, 2, 1}}));
}

TEST(Ply, ReadsTextureCoordinatesOfVerticesUnderAllNames) {
  for (const auto& [u, v] : {std::pair{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}}) {
    const std::string header =
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n";
    const ImportedMesh imported = must_read(
        header + "property float " + u + "\nproperty float " + v + "\nend_header\n0 0 0 0.25 0.5\n", MeshFormat::kPly);
    ASSERT_EQ(imported.mesh.uvs.values.size(), 1u);
    EXPECT_EQ(imported.mesh.uvs.values[0], Vec2(0.25f, 0.5f));
  }
}

TEST(Ply, ReadsHeadersWithAnyLineEnd) {
  std::string text = kFourVertices + "element face 1\nproperty list uchar int vertex_indices\nend_header\n" +
                     kFourPoints + "3 0 1 2\n";
  const Mesh expected = must_read(text, MeshFormat::kPly).mesh;
  std::string carriage_returns = text;
  std::replace(carriage_returns.begin(), carriage_returns.end(), '\n', '\r');
  EXPECT_EQ(must_read(carriage_returns, MeshFormat::kPly).mesh.faces, expected.faces);
  std::string both;
  for (const char c : text)
    both += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(must_read(both, MeshFormat::kPly).mesh.positions, expected.positions);
}

TEST(Ply, NotesWhatLiesBehindTheLastElement) {
  const std::string text = kFourVertices + "end_header\n" + kFourPoints;
  EXPECT_TRUE(must_read(text + "\n \n", MeshFormat::kPly).notes.empty());
  EXPECT_EQ(must_read(text + "garbage", MeshFormat::kPly).notes.size(), 1u);
  std::string binary = written(test::awkward_tetrahedron(false), false);
  EXPECT_EQ(must_read(binary + "xyz", MeshFormat::kPly).notes.at(0), "3 bytes behind the last element left out");
}

TEST(Ply, WritesTheSameBytesForTheSameMesh) {
  EXPECT_EQ(written(test::awkward_tetrahedron(true), false), written(test::awkward_tetrahedron(true), false));
}

}  // namespace
}  // namespace limn
