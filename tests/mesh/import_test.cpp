#include "limn/mesh/import.h"

#include <chrono>
#include <gtest/gtest.h>
#include <limits>
#include <string>
#include <sys/resource.h>

#include "limn/mesh/formats/finish.h"
#include "limn/mesh/formats/formats.h"
#include "limn/mesh/formats/reference.h"

#include "support/mesh_bits.h"
#include "support/temp_folder.h"

namespace limn {
namespace {

using test::append_bytes;
using test::bytes_of;
using test::must_read;
using test::TempFolder;

const std::string kHeader =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
    "property list uchar int vertex_indices\nend_header\n";
const std::string kPoints = "0 0 0\n1 0 0\n0 1 0\n";
const std::string kFacet =
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";

std::string binary_ply(std::uint64_t vertices, std::uint64_t faces, const std::string& body) {
  return "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(vertices) +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " + std::to_string(faces) +
         "\nproperty list uint int vertex_indices\nend_header\n" + body;
}

std::string binary_stl(std::uint32_t claimed, std::size_t bytes) {
  std::string file(80, ' ');
  append_bytes(file, claimed);
  return file + std::string(bytes, '\0');
}

std::string list_of(std::uint32_t count, std::initializer_list<std::int32_t> indices) {
  std::string body;
  append_bytes(body, count);
  for (const std::int32_t index : indices)
    append_bytes(body, index);
  return body;
}

struct Broken {
  const char* what;
  MeshFormat format;
  std::string content;
  ErrorCode code;
  std::string cause;  ///< in the message
  std::string place;  ///< in where
};

std::vector<Broken> broken_files() {
  using enum MeshFormat;
  const ErrorCode bad = ErrorCode::kUnreadable;
  const std::string three_points(36, '\0');
  return {
      {"empty file", kPly, "", bad, "empty", ""},
      {"no magic word", kPly, "plx\n", bad, "does not begin with 'ply'", "line 1"},
      {"header without end", kPly, kHeader.substr(0, 60), bad, "within the header", "line"},
      {"unknown keyword", kPly, "ply\nformat ascii 1.0\nhello\nend_header\n", bad, "'hello'", "line 3"},
      {"unknown encoding", kPly, "ply\nformat utf8 1.0\nend_header\n", bad, "'utf8'", "line 2"},
      {"no encoding", kPly, "ply\nend_header\n", bad, "names no format", "line 2"},
      {"negative count", kPly, "ply\nformat ascii 1.0\nelement vertex -3\n", bad, "'-3'", "line 3"},
      {"unknown type", kPly, "ply\nformat ascii 1.0\nelement vertex 1\nproperty half x\n", bad, "'half'", "line 4"},
      {"fractional list count", kPly, "ply\nformat ascii 1.0\nelement face 1\nproperty list float int i\n", bad,
       "'float'", "line 4"},
      {"element twice", kPly, "ply\nformat ascii 1.0\nelement vertex 1\nelement vertex 1\n", bad, "twice", "line 4"},
      {"no vertices", kPly, "ply\nformat ascii 1.0\nend_header\n", bad, "no vertex element", "header"},
      {"no z", kPly, "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nend_header\n", bad,
       "lack a property", "header"},
      {"no indices", kPly,
       "ply\nformat ascii 1.0\nelement vertex 0\nproperty int x\nproperty int y\nproperty int z\nelement face "
       "0\nend_header\n",
       bad, "no list 'vertex_indices'", "header"},
      {"text cut in a vertex", kPly, kHeader + "0 0 0\n1 0", bad, "truncated", "vertex"},
      {"text cut late in a vertex", kPly, kHeader + "0 0 0 \n1 0 0\n0      1", bad, "fewer values",
       "vertex 2 (line 12)"},
      {"text cut before a face", kPly, kHeader + "0.0 0 0\n1 0 0\n0 1 0\n", bad, "ends here", "face 0 (line 12)"},
      {"one vertex too few", kPly, kHeader + "0 0 0\n1 0 0\n3 0 1 2\n", bad, "'2' is more than", "vertex 2 (line 12)"},
      {"no number", kPly, kHeader + "0 0 0\n1 zero 0\n0 1 0\n3 0 1 2\n", bad, "'zero'", "vertex 1 (line 11)"},
      {"index out of range", kPly, kHeader + kPoints + "3 0 1 3\n", bad, "vertex 3, but there are 3",
       "face 0 (line 13)"},
      {"negative index", kPly, kHeader + kPoints + "3 0 1 -1\n", bad, "vertex -1", "face 0 (line 13)"},
      {"negative list", kPly, kHeader + kPoints + "-3 0 1 2\n", bad, "a list of -3 values", "face 0"},
      {"huge list", kPly, kHeader + kPoints + "4000000000 0 1 2\n", bad, "a list of 4000000000", "face 0"},
      {"fractional index", kPly, kHeader + kPoints + "3 0 1 1.5\n", bad, "'1.5'", "face 0 (line 13)"},
      {"NaN", kPly, kHeader + "0 0 0\nnan 0 0\n0 1 0\n3 0 1 2\n", ErrorCode::kUnsuitable, "not finite", "vertex 1"},
      {"beyond a float", kPly, kHeader + "0 0 0\n1e39 0 0\n0 1 0\n3 0 1 2\n", ErrorCode::kUnsuitable, "inf",
       "vertex 1"},
      {"3 GB of vertices", kPly, binary_ply(250'000'000, 1, "few bytes"), bad, "claims 250000000 vertex", "vertex 0"},
      {"3 GB of faces", kPly, binary_ply(3, 750'000'000, three_points), bad, "claims 750000000 face", "face"},
      {"more than 64 bits of bytes", kPly, binary_ply(~std::uint64_t{0}, 1, ""), bad, "claims", "vertex 0"},
      {"binary cut in a vertex", kPly, binary_ply(3, 0, std::string(30, '\0')), bad, "claims 3 vertex", "vertex 2"},
      {"binary cut in a face", kPly, binary_ply(3, 1, three_points + list_of(3, {0, 1})), bad, "a list of 3 values",
       "face 0"},
      {"binary huge list", kPly, binary_ply(3, 1, three_points + list_of(0xffffffffu, {0, 1})), bad,
       "a list of 4294967295", "face 0"},
      {"binary index out of range", kPly,
       binary_ply(3, 2, three_points + list_of(3, {0, 1, 2}) + list_of(3, {0, 1, 7})), bad, "vertex 7, but there are 3",
       "face 1"},
      {"binary negative index", kPly, binary_ply(3, 1, three_points + list_of(3, {0, 1, -9})), bad, "vertex -9",
       "face 0"},

      {"binary STL of a few bytes", kStl, "abc", bad, "truncated", "byte 3"},
      {"binary STL cut", kStl, binary_stl(2, 70), bad, "claims 2 facets, 1 are there", "facet 1 (byte 154)"},
      {"binary STL of 200 GB", kStl, binary_stl(0xffffffffu, 100), bad, "claims 4294967295 facets, 2", "facet 2"},
      {"text STL cut", kStl, "solid a\n" + kFacet + kFacet.substr(0, 50), bad, "truncated: the file ends in facet 1",
       "line 12"},
      {"text STL, two vertices", kStl,
       "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 0 0 0\nendloop\nendfacet\n", bad,
       "facet 0 has 2 vertices", "line 7"},
      {"text STL, four vertices", kStl,
       "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 0 0 0\nvertex 0 0 0\nvertex 0 0 "
       "0\nendloop\nendfacet\n",
       bad, "more than three", "line 7"},
      {"text STL, a word", kStl, "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 x\n", bad, "lacks three numbers",
       "line 4"},
      {"text STL, unknown keyword", kStl, "solid\nfacet normal 0 0 1\nouter loop\nvortex 0 0 0\n", bad, "'vortex'",
       "line 4"},
      {"text STL, facet in a facet", kStl, "solid\nfacet normal 0 0 1\nfacet normal 0 0 1\n", bad, "not closed",
       "line 3"},
      {"text STL, NaN", kStl,
       "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex nan 0 0\nvertex 0 0 "
       "0\nendloop\nendfacet\nendsolid\n",
       ErrorCode::kUnsuitable, "nan", "vertex 1"},

      {"OFF without keyword", kOff, "hello\n", bad, "does not begin with 'OFF'", "line 1"},
      {"binary OFF", kOff, "OFF BINARY\n", bad, "binary OFF", "line 1"},
      {"OFF in four dimensions", kOff, "4OFF\n1 0 0\n0 0 0 1\n", bad, "three dimensions", "line 1"},
      {"OFF without counts", kOff, "OFF\n", bad, "before its counts", "line"},
      {"OFF with half its counts", kOff, "OFF\n3\n", bad, "counts", "line 2"},
      {"OFF with negative counts", kOff, "OFF\n-3 1 0\n", bad, "a count of -3", "line 2"},
      {"OFF of 3 GB", kOff, "OFF\n250000000 1 0\n0 0 0\n", bad, "truncated: 250000000 vertices", "line 2"},
      {"OFF, too few vertices", kOff, "OFF\n3 1 0\n0 0 0\n1 0 0\n3 0 1 2\n", bad, "ends before face 0", "line 5"},
      {"OFF, too few faces", kOff, "OFF\n3 2 0\n" + kPoints + "3 0 1 2\n", bad, "ends before face 1", "line 6"},
      {"OFF, index out of range", kOff, "OFF\n3 1 0\n" + kPoints + "3 0 1 3\n", bad, "face 0 refers to vertex 3",
       "line 6"},
      {"OFF, short face", kOff, "OFF\n3 1 0\n" + kPoints + "3 0 1\n", bad, "claims 3 corners, 2", "line 6"},
      {"OFF, a word", kOff, "OFF\n3 1 0\n0 0 0\n1 0 0\n0 x 0\n3 0 1 2\n", bad, "'x'", "line 5"},
      {"OFF, infinity", kOff, "OFF\n3 1 0\n0 0 0\n1 0 -inf\n0 0 0\n3 0 1 2\n", ErrorCode::kUnsuitable, "-inf",
       "vertex 1"},
      {"COFF without colour", kOff, "COFF\n1 0 0\n0 0 0 1\n", bad, "vertex 0 has 1 numbers", "line 3"},
  };
}

TEST(ReadMesh, SaysWhatIsWrongWithBrokenFilesAndWhere) {
  const TempFolder folder;
  for (const Broken& broken : broken_files()) {
    SCOPED_TRACE(broken.what);
    const auto memory = read_mesh(bytes_of(broken.content), broken.format, "model.x");
    ASSERT_FALSE(memory);
    EXPECT_EQ(memory.error().code, broken.code);
    EXPECT_EQ(memory.error().file, "model.x");
    EXPECT_NE(memory.error().message.find(broken.cause), std::string::npos) << format_error(memory.error());
    EXPECT_NE(memory.error().where.find(broken.place), std::string::npos) << format_error(memory.error());
    const auto path = folder.write("model.x", broken.content);
    const auto file = read_mesh(path, ImportOptions{.format = broken.format, .progress = {}});
    ASSERT_FALSE(file);
    EXPECT_EQ(file.error().message, memory.error().message);
    EXPECT_EQ(file.error().file, path.string());
  }
}

long peak_kib() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

TEST(ReadMesh, BelievesNoHeaderThatClaimsMoreThanTheFileHolds) {
  const long before = peak_kib();
  const auto start = std::chrono::steady_clock::now();
  for (const Broken& broken : broken_files()) {
    EXPECT_FALSE(read_mesh(bytes_of(broken.content), broken.format, "x"));
  }
  EXPECT_LT(peak_kib() - before, 64 * 1024);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
}

TEST(ReadMesh, RefusesDirectoriesAndMissingFiles) {
  const TempFolder folder;
  const auto directory = read_mesh(folder.path());
  ASSERT_FALSE(directory);
  EXPECT_EQ(directory.error().code, ErrorCode::kUnreadable);
  EXPECT_EQ(directory.error().message, "is a directory");
  EXPECT_FALSE(read_mesh(folder / "absent.ply"));
}

TEST(ReadMesh, TellsFormatsByExtensionThenByContent) {
  EXPECT_EQ(format_of("a/b.PLY"), MeshFormat::kPly);
  EXPECT_EQ(format_of("b.Stl"), MeshFormat::kStl);
  EXPECT_EQ(format_of("b.off"), MeshFormat::kOff);
  EXPECT_EQ(format_of("b.obj"), MeshFormat::kObj);
  EXPECT_EQ(format_of("b.glTF"), MeshFormat::kGltf);
  EXPECT_EQ(format_of("b.glb"), MeshFormat::kGlb);
  EXPECT_EQ(format_of("b.3ds"), MeshFormat::kOther);
  EXPECT_EQ(format_of("b"), MeshFormat::kUnknown);
  EXPECT_EQ(format_of("-"), MeshFormat::kUnknown);
  const std::string ply = kHeader + kPoints + "3 0 1 2\n";
  const std::string stl = "solid a\n" + kFacet + "endsolid\n";
  const std::string off = "# made by hand\nCOFF\n1 0 0\n0 0 0 1 1 1\n";
  EXPECT_EQ(must_read(ply, MeshFormat::kUnknown).format, MeshFormat::kPly);
  EXPECT_EQ(must_read(stl, MeshFormat::kUnknown).format, MeshFormat::kStl);
  EXPECT_EQ(must_read(binary_stl(1, 50), MeshFormat::kOther).format, MeshFormat::kStl);
  EXPECT_EQ(must_read(off, MeshFormat::kUnknown).format, MeshFormat::kOff);
  const TempFolder folder;
  EXPECT_EQ(read_mesh(folder.write("model", ply))->format, MeshFormat::kPly);
}

TEST(ReadMesh, SaysWhenTheContentContradictsTheExtension) {
  const TempFolder folder;
  const auto imported = read_mesh(folder.write("model.ply", "solid a\n" + kFacet + "endsolid\n"));
  ASSERT_FALSE(imported);
  EXPECT_NE(imported.error().remedy.find("looks like STL"), std::string::npos) << format_error(imported.error());
}

TEST(ReadMesh, StopsWhenAskedTo) {
  const TempFolder folder;
  ImportOptions options;
  options.progress = [](std::string_view, double) { return false; };
  const auto imported = read_mesh(folder.write("model.ply", kHeader + kPoints + "3 0 1 2\n"), options);
  ASSERT_FALSE(imported);
  EXPECT_EQ(imported.error().code, ErrorCode::kCancelled);
}

TEST(ReadMesh, ReadsAFileWithoutFaces) {
  const Mesh points = must_read("OFF\n1 0 0\n1 2 3\n", MeshFormat::kOff).mesh;
  EXPECT_EQ(points.positions.size(), 1u);
  EXPECT_TRUE(points.faces.empty());
  EXPECT_TRUE(must_read("solid\nendsolid\n", MeshFormat::kStl).mesh.positions.empty());
}

Result<ImportedMesh> finished(Mesh mesh) {
  ImportedMesh imported{std::move(mesh), MeshFormat::kOther, {}};
  const Result<void> done = formats::finish(imported, "test");
  if (!done) return tl::unexpected(done.error());
  return imported;
}

Mesh one_triangle() {
  Mesh mesh;
  mesh.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  mesh.faces = {{0, 1, 2}};
  return mesh;
}

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

TEST(Finish, ScalesNormalsAndReplacesThoseWithoutADirection) {
  Mesh mesh = one_triangle();
  mesh.normals.values = {Vec3(0, 3, 4), Vec3(0, 0, 0), Vec3(kNan, 0, 1)};
  const auto imported = finished(mesh);
  ASSERT_TRUE(imported);
  EXPECT_EQ(imported->mesh.normals.values[0], Vec3(0, 0.6f, 0.8f));
  EXPECT_EQ(imported->mesh.normals.values[1], Vec3(0, 0, 1));
  EXPECT_EQ(imported->mesh.normals.values[2], Vec3(0, 0, 1));
  EXPECT_EQ(imported->notes.size(), 2u);
}

TEST(Finish, LeavesUnitNormalsAsTheyAre) {
  Mesh mesh = one_triangle();
  const Vec3 nearly(0.57735026f, 0.57735026f, 0.5773503f);
  mesh.normals.values = {nearly, nearly, nearly};
  const auto imported = finished(mesh);
  ASSERT_TRUE(imported);
  EXPECT_TRUE(test::same_bits(imported->mesh.normals.values, mesh.normals.values));
  EXPECT_TRUE(imported->notes.empty());
}

TEST(Finish, DropsAttributesThatAreNotFiniteAndSaysSo) {
  Mesh mesh = one_triangle();
  mesh.uvs.values = {Vec2(0), Vec2(0, kNan), Vec2(0)};
  mesh.colors.values = {Vec4(0), Vec4(0), Vec4(0, 0, 0, std::numeric_limits<float>::infinity())};
  mesh.tags = {0, kNan, 0};
  const auto imported = finished(mesh);
  ASSERT_TRUE(imported);
  EXPECT_TRUE(imported->mesh.uvs.empty());
  EXPECT_TRUE(imported->mesh.colors.empty());
  EXPECT_TRUE(imported->mesh.tags.empty());
  EXPECT_EQ(imported->notes.size(), 3u);
}

TEST(Finish, RefusesIndicesAndCountsThatDoNotFit) {
  Mesh vertex = one_triangle();
  vertex.faces.push_back({0, 1, 3});
  EXPECT_EQ(finished(vertex).error().where, "face 1");
  Mesh few = one_triangle();
  few.normals.values = {Vec3(0, 0, 1)};
  EXPECT_EQ(finished(few).error().where, "normals");
  Mesh corner = one_triangle();
  corner.uvs.values = {Vec2(0)};
  corner.uvs.indices = {0, 0, 1};
  EXPECT_EQ(finished(corner).error().where, "face 0");
  Mesh material = one_triangle();
  material.face_materials = {0};
  EXPECT_EQ(finished(material).error().where, "face 0");
}

TEST(ReadReference, ReadsFilesBesideAndBelowTheModel) {
  const TempFolder folder;
  folder.write("model/a b.bin", "abc");
  folder.write("model/deep/er.bin", "de");
  folder.write("model/100%25.bin", "f");
  const auto home = folder / "model";
  EXPECT_EQ(formats::read_reference(home, "a b.bin")->size(), 3u);
  EXPECT_EQ(formats::read_reference(home, "a%20b.bin")->size(), 3u);
  EXPECT_EQ(formats::read_reference(home, "./deep/er.bin")->size(), 2u);
  EXPECT_EQ(formats::read_reference(home, "100%25.bin")->size(), 1u);
  EXPECT_FALSE(formats::read_reference(home, "absent.bin"));
  EXPECT_FALSE(formats::read_reference(home, "deep"));
}

TEST(ReadReference, NeverLeavesTheModelsFolder) {
  const TempFolder folder;
  folder.write("secret.bin", "secret");
  folder.write("model/near.bin", "near");
  const auto home = folder / "model";
  std::filesystem::create_symlink(folder / "secret.bin", home / "link.bin");
  std::filesystem::create_symlink(folder.path(), home / "folder");
  std::filesystem::create_symlink(home / "near.bin", home / "inner.bin");
  EXPECT_TRUE(formats::read_reference(home, "inner.bin"));
  const std::string absolute = (folder / "secret.bin").string();
  for (const std::string& reference : std::vector<std::string>{"",
                                                               absolute,
                                                               "/etc/passwd",
                                                               "%2Fetc/passwd",
                                                               "../secret.bin",
                                                               "x/../../secret.bin",
                                                               "%2e%2e/secret.bin",
                                                               "%2E%2e%2fsecret.bin",
                                                               "..%2Fsecret.bin",
                                                               "..\\secret.bin",
                                                               "%5c%5cserver%5cshare",
                                                               "..%5csecret.bin",
                                                               "C:secret.bin",
                                                               "file://" + absolute,
                                                               "file:secret.bin",
                                                               "http://host/secret.bin",
                                                               "HTTPS:secret.bin",
                                                               "http%3a//host/x",
                                                               "data:,x",
                                                               "link.bin",
                                                               "folder/secret.bin",
                                                               std::string("near.bin\0", 9),
                                                               "near.bin%00"}) {
    const auto read = formats::read_reference(home, reference);
    ASSERT_FALSE(read) << reference;
    EXPECT_EQ(read.error().code, ErrorCode::kUnreadable);
    EXPECT_NE(read.error().message.find("the reference"), std::string::npos);
  }
  EXPECT_FALSE(formats::read_reference({}, "near.bin"));
}

}  // namespace
}  // namespace limn
