#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "limn/base/random.h"
#include "limn/mesh/formats/formats.h"
#include "limn/mesh/formats/parse_number.h"
#include "limn/mesh/formats/polygon.h"

#include "support/mesh_source.h"
#include "support/temp_folder.h"

namespace limn {
namespace {

using formats::read_obj;
using test::bits;
using test::source_of;
using test::TempFolder;

ImportedMesh read(std::string_view text, const std::filesystem::path& folder = {}) {
  Result<ImportedMesh> result = read_obj(source_of(text, folder));
  EXPECT_TRUE(result.has_value()) << (result ? "" : format_error(result.error()));
  return result ? *std::move(result) : ImportedMesh{};
}

bool has_note(const ImportedMesh& mesh, std::string_view part) {
  return std::any_of(mesh.notes.begin(), mesh.notes.end(),
                     [part](const std::string& note) { return note.find(part) != std::string::npos; });
}

constexpr std::string_view kTinyPng = "\x89PNG\r\n\x1a\n the rest of the picture is never decoded by the reader";

TEST(Obj, ReadsTrianglesInFileOrder) {
  const ImportedMesh obj = read("# comment\no thing\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 9 9 9\nf 1 2 3\n");
  EXPECT_EQ(obj.format, MeshFormat::kObj);
  ASSERT_EQ(obj.mesh.positions.size(), 4u);
  EXPECT_EQ(obj.mesh.positions[3], Vec3(9, 9, 9));
  ASSERT_EQ(obj.mesh.faces.size(), 1u);
  EXPECT_EQ(obj.mesh.faces[0], (Triangle{0, 1, 2}));
  EXPECT_TRUE(obj.mesh.normals.empty() && obj.mesh.uvs.empty() && obj.mesh.colors.empty());
  EXPECT_TRUE(obj.notes.empty());
}

TEST(Obj, KeepsCornerAttributesIndexed) {
  const ImportedMesh obj = read(
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt .5 1\nvn 0 0 1\nvn 0 0 -1\nvn 1 0 0\n"
      "f 1/1/3 2/2/2 3/1/1\nf 1/2/1 3/2/1 4/1/1\n");
  const Mesh& mesh = obj.mesh;
  EXPECT_EQ(mesh.uvs.indices, (std::vector<std::uint32_t>{0, 1, 0, 1, 1, 0}));
  EXPECT_EQ(mesh.normals.indices, (std::vector<std::uint32_t>{2, 1, 0, 0, 0, 0}));
  EXPECT_EQ(mesh.corner(mesh.normals, 0, 0), Vec3(1, 0, 0));
  EXPECT_EQ(mesh.corner(mesh.uvs, 0, 1), Vec2(0.5f, 1));
}

TEST(Obj, LeavesOutIndicesThatOnlyRepeatTheVertexNumber) {
  const ImportedMesh obj = read("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvn 0 0 1\nvn 0 0 1\nf 1//1 2//2 3//3\n");
  EXPECT_TRUE(obj.mesh.normals.indices.empty());
  EXPECT_EQ(obj.mesh.normals.values.size(), 3u);
}

TEST(Obj, CountsNegativeIndicesBackFromTheLastElementDefined) {
  const ImportedMesh obj = read("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 5 5 5\nf -4 -1 -3\n");
  EXPECT_EQ(obj.mesh.faces, (std::vector<Triangle>{{0, 1, 2}, {0, 3, 1}}));
}

TEST(Obj, ReadsFacesThatPrecedeTheirVertices) {
  EXPECT_EQ(read("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n").mesh.faces, (std::vector<Triangle>{{0, 1, 2}}));
}

TEST(Obj, UnderstandsEveryLineEndAndContinuation) {
  for (const std::string_view text :
       {"v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n", "v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3\r",
        "v 0 \\\n0 0\nv 1 0 0\\\r\n\nv 0 1 0 # end\nf 1 2 \\\n3",
        "\xef\xbb\xbfv\t0  0\t0 \n\n  v 1 0 0\nv +0 1 0\nf 1 2 3 "}) {
    const ImportedMesh obj = read(text);
    EXPECT_EQ(obj.mesh.positions, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})) << text;
    EXPECT_EQ(obj.mesh.faces.size(), 1u) << text;
  }
}

TEST(Obj, FillsCornersThatLackAnAttributeAndSaysSo) {
  const ImportedMesh obj =
      read("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvn 1 0 0\nvt 1 1\nf 1 2 3\nf 1/1/1 2/1/1 4/1/1\nf 2 3 4\n");
  const Mesh& mesh = obj.mesh;
  ASSERT_EQ(mesh.normals.indices.size(), 9u);
  EXPECT_EQ(mesh.corner(mesh.normals, 0, 2), Vec3(0, 0, 1));
  EXPECT_EQ(mesh.corner(mesh.normals, 1, 0), Vec3(1, 0, 0));
  EXPECT_NEAR(mesh.corner(mesh.normals, 2, 1).x, std::sqrt(1.0 / 3.0), 1e-6);
  EXPECT_EQ(mesh.corner(mesh.uvs, 2, 2), Vec2(0, 0));
  EXPECT_TRUE(has_note(obj, "6 corners without a normal"));
  EXPECT_TRUE(has_note(obj, "6 corners without a texture coordinate"));
}

TEST(Obj, ReadsVertexColors) {
  const ImportedMesh obj = read("v 0 0 0 1 0 .5\nv 1 0 0\nv 0 1 0 0 0 1 .25\nf 1 2 3\n");
  EXPECT_EQ(obj.mesh.colors.values, (std::vector<Vec4>{{1, 0, 0.5f, 1}, {1, 1, 1, 1}, {0, 0, 1, 0.25f}}));
  EXPECT_TRUE(has_note(obj, "1 vertices without a colour"));
}

TEST(Obj, NamesWhatItLeavesOut) {
  const ImportedMesh obj = read(
      "g a\nv 0 0 0 2\nv 1 0 0\nv 1 1 0\nv 0 1 0\nl 1 2\np 1\nf 1 2\nf 1 2 3 4\ng b\ns 1\ncurv 0 1 1 2\nfrobnicate "
      "3\nvn 0 0 1\n");
  for (const char* part : {"1 polygons triangulated", "2 point and line", "1 faces of fewer",
                           "1 statements of free-form", "1 vertex weights", "2 objects and groups", "smoothing groups",
                           "1 normals that no face uses", "the first \"frobnicate\" in line 13"}) {
    EXPECT_TRUE(has_note(obj, part)) << part;
  }
  EXPECT_EQ(obj.mesh.faces.size(), 2u);
}

TEST(Obj, CutsConcavePolygonsWithinTheirOutline) {
  // An arrow head whose fan about corner 0 would leave the outline.
  const ImportedMesh obj = read(
      "v 0 0 0\nv 4 -3 0\nv 1 0 0\nv 4 3 0\nvn 0 0 1\nvt 0 0\nvt 1 0\nvt 2 0\nvt 3 0\nf 2/2/1 3/3/1 4/4/1 1/1/1\n");
  ASSERT_EQ(obj.mesh.faces.size(), 2u);
  for (FaceId f = 0; f < 2; ++f) {
    const Triangle& t = obj.mesh.faces[f];
    const Vec3 n = glm::cross(obj.mesh.positions[t[1]] - obj.mesh.positions[t[0]],
                              obj.mesh.positions[t[2]] - obj.mesh.positions[t[0]]);
    EXPECT_GT(n.z, 0.0f);
    for (int c = 0; c < 3; ++c) {
      EXPECT_EQ(obj.mesh.corner(obj.mesh.uvs, f, c).x, static_cast<float>(t[static_cast<std::size_t>(c)]))
          << "uv left its corner";
    }
  }
}

TEST(Obj, TrianglesOfAPolygonCoverItsArea) {
  Random random(7);
  for (int round = 0; round < 200; ++round) {
    const std::size_t n = 3 + round % 60;
    std::vector<Vec3> star;
    double area = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      const double angle = 6.283185307179586 * static_cast<double>(i) / static_cast<double>(n);
      const double radius = random.uniform(0.1, 1.0);
      star.emplace_back(3.0f, radius * std::cos(angle), radius * std::sin(angle));
    }
    for (std::size_t i = 0; i < n; ++i)
      area += 0.5 * glm::cross(DVec3(star[i]), DVec3(star[(i + 1) % n])).x;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    formats::triangulate(star, triangles);
    ASSERT_EQ(triangles.size(), n - 2);
    double sum = 0.0;
    for (const auto& t : triangles) {
      sum += 0.5 * std::abs(glm::cross(DVec3(star[t[1]]) - DVec3(star[t[0]]), DVec3(star[t[2]]) - DVec3(star[t[0]])).x);
    }
    // A star may wind backwards between three directions only when n is tiny; unsigned areas add up exactly when
    // nothing overlaps.
    if (n > 4) {
      EXPECT_NEAR(sum, area, 1e-5) << n;
    }
  }
}

TEST(Obj, NumbersAreRoundedCorrectlyAndKeepTheirBits) {
  Random random(3);
  Mesh mesh;
  for (int i = 0; i < 30000; ++i) {
    Vec3 p;
    for (int k = 0; k < 3; ++k) {
      float value = std::bit_cast<float>(static_cast<std::uint32_t>(random.next()));
      p[k] = std::isfinite(value) ? value : 0.1f;
    }
    mesh.positions.push_back(p);
  }
  mesh.positions.push_back({-0.0f, std::numeric_limits<float>::denorm_min(), std::numeric_limits<float>::max()});
  for (std::uint32_t i = 0; i + 2 < mesh.positions.size(); i += 3)
    mesh.faces.push_back({i, i + 1, i + 2});
  const auto files = formats::write_obj(mesh, "m.obj");
  ASSERT_TRUE(files.has_value());
  const Mesh back = read((*files)[0].bytes).mesh;
  ASSERT_EQ(back.positions.size(), mesh.positions.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    ASSERT_EQ(bits(back.positions[i]), bits(mesh.positions[i])) << i;
  EXPECT_EQ(back.faces, mesh.faces);
}

TEST(Obj, NumbersBeyondFloatBecomeZeroOrInfinity) {
  const float infinity = std::numeric_limits<float>::infinity();
  const struct {
    const char* text;
    float value;
  } cases[] = {{"1e-60", 0.0f},
               {"-1e-60", -0.0f},
               {"1e60", infinity},
               {"-1e60", -infinity},
               {"1e999", infinity},
               {"-1e999", -infinity},
               {"1e-999", 0.0f},
               {"+2.5", 2.5f},
               {".5", 0.5f},
               {"5.", 5.0f},
               {"0.1000000014901161193847656250000000000000000001", std::bit_cast<float>(0x3dcccccdu)}};
  for (const auto& c : cases) {
    float value = 77.0f;
    EXPECT_EQ(formats::parse_float(c.text, value), std::string_view(c.text).size()) << c.text;
    EXPECT_EQ(std::bit_cast<std::uint32_t>(value), std::bit_cast<std::uint32_t>(c.value)) << c.text;
  }
  float value = 0.0f;
  for (const char* text : {"", "+", "+-1", "++1", "x", "-", ".", "e5"})
    EXPECT_EQ(formats::parse_float(text, value), 0u) << text;
}

struct Broken {
  std::string text;
  ErrorCode code;
  const char* where;
  const char* message;
};

TEST(Obj, BrokenFilesAreRefusedNamingLineAndCause) {
  const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  const std::vector<Broken> cases = {
      {"", ErrorCode::kUnreadable, "line 1", "empty"},
      {"this is a letter\nnot a model\n", ErrorCode::kUnreadable, "line 1", "no OBJ statement"},
      {std::string("\0\1\2\3\0\0\0", 7), ErrorCode::kUnreadable, "line 1", "no OBJ statement"},
      {"v 0 0\n", ErrorCode::kUnreadable, "line 1", "2 numbers, needs 3"},
      {"v 0 0 zero\n", ErrorCode::kUnreadable, "line 1", "\"zero\" is not a number"},
      {"v 0 0 1x\n", ErrorCode::kUnreadable, "line 1", "not a number"},
      {"v 1 2 3 4 5 6 7 8 9\n", ErrorCode::kUnreadable, "line 1", "more than"},
      {"v 0 0 0\nv nan 0 0\n", ErrorCode::kUnsuitable, "line 2", "vertex 2 has a coordinate that is not finite"},
      {"v 0 0 1e39\n", ErrorCode::kUnsuitable, "line 1", "not finite"},
      {"v 0 0 0 inf 0 0\n", ErrorCode::kUnsuitable, "line 1", "colour"},
      {"vt nan 0\n", ErrorCode::kUnsuitable, "line 1", "texture coordinate 1"},
      {"vn 0 0\n", ErrorCode::kUnreadable, "line 1", "normal has 2"},
      {three + "f 1 2 4\n", ErrorCode::kUnreadable, "line 4", "face 1 names vertex 4, but the file has 3"},
      {three + "f 1 2 3\nf 1/1 2/1 3/1\n", ErrorCode::kUnreadable, "line 5",
       "face 2 names texture coordinate 1, but the file has 0"},
      {three + "f 1//1 2//1 3//9\nvn 0 0 1\n", ErrorCode::kUnreadable, "line 4", "names normal 9"},
      {three + "f 0 1 2\n", ErrorCode::kUnreadable, "line 4", "out of range"},
      {three + "f -4 1 2\n", ErrorCode::kUnreadable, "line 4", "out of range (3 defined"},
      {three + "f 1 2 4294967296\n", ErrorCode::kUnreadable, "line 4", "out of range"},
      {three + "f 1 2 99999999999999999999999\n", ErrorCode::kUnreadable, "line 4", "malformed vertex index"},
      {three + "f 1 2 a\n", ErrorCode::kUnreadable, "line 4", "malformed vertex index"},
      {three + "f 1 2 3/x\n", ErrorCode::kUnreadable, "line 4", "malformed texture"},
      {three + "f 1 2 /3\n", ErrorCode::kUnreadable, "line 4", "without a vertex index"},
      {three + "f 1/1/1/1 2 3\n", ErrorCode::kUnreadable, "line 4", "malformed corner"},
      {three + "f 1.5 2 3\n", ErrorCode::kUnreadable, "line 4", "malformed corner"},
  };
  for (const Broken& broken : cases) {
    const Result<ImportedMesh> result = read_obj(source_of(broken.text));
    ASSERT_FALSE(result.has_value()) << broken.text;
    EXPECT_EQ(result.error().code, broken.code) << broken.text;
    EXPECT_EQ(result.error().where, broken.where) << broken.text;
    EXPECT_EQ(result.error().file, "model");
    EXPECT_NE(result.error().message.find(broken.message), std::string::npos) << result.error().message << "\n"
                                                                              << broken.text;
  }
}

TEST(Obj, ProgressCancels) {
  std::string text;
  for (int i = 0; i < 70000; ++i)
    text += "v 0 0 0\n";
  formats::Source source = source_of(text);
  source.progress = [](std::string_view, double) { return false; };
  const Result<ImportedMesh> result = read_obj(source);
  ASSERT_FALSE(result.has_value());
  EXPECT_EQ(result.error().code, ErrorCode::kCancelled);
}

TEST(ObjMaterials, AreReadFromTheLibraryBeside) {
  const TempFolder folder;
  folder.write("two names.mtl",
               "newmtl red paint\nKd 1 0.25 0\nd 0.5\nmap_Kd -s 2 2 -bm 1 -clamp on skin file.png\nnewmtl blue\nKd 0 0 "
               "1\nPr 0.125\nPm 1\nTr 0.25\n");
  folder.write("skin file.png", kTinyPng);
  const ImportedMesh obj = read(
      "mtllib two names.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nusemtl blue\nf 1 2 4 3\nusemtl red paint\nf 1 2 "
      "3\nusemtl lost\nf 3 2 1\n",
      folder.path());
  const Mesh& mesh = obj.mesh;
  ASSERT_EQ(mesh.materials.size(), 3u);
  EXPECT_EQ(mesh.materials[0].name, "red paint");
  EXPECT_EQ(mesh.materials[0].base_color, Vec4(1, 0.25f, 0, 0.5f));
  EXPECT_EQ(mesh.materials[0].base_color_image.size(), kTinyPng.size());
  EXPECT_EQ(mesh.materials[0].base_color_image_mime, "image/png");
  EXPECT_EQ(mesh.materials[1].base_color, Vec4(0, 0, 1, 0.75f));
  EXPECT_EQ(mesh.materials[1].roughness, 0.125f);
  EXPECT_EQ(mesh.materials[1].metallic, 1.0f);
  EXPECT_EQ(mesh.materials[2].name, "lost");
  EXPECT_EQ(mesh.face_materials, (std::vector<std::uint32_t>{1, 1, 0, 2}));
}

TEST(ObjMaterials, MissingLibraryIsANote) {
  const TempFolder folder;
  const ImportedMesh obj = read("mtllib lost.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n", folder.path());
  EXPECT_TRUE(has_note(obj, "\"lost.mtl\" not read"));
  EXPECT_EQ(obj.mesh.materials.size(), 1u);
  EXPECT_TRUE(obj.mesh.face_materials.empty());
}

TEST(ObjMaterials, APictureUnderManySpellingsKeepsToOneBudget) {
  constexpr std::size_t kSize = std::size_t{32} << 20;
  const TempFolder folder;
  folder.write("skin.png", std::string(kTinyPng) + std::string(kSize - kTinyPng.size(), ' '));
  std::string library;
  std::string name = "skin.png";
  for (char material = 'a'; material < 'l'; ++material) {
    library += std::string("newmtl ") + material + "\nmap_Kd " + name + "\n";
    name.insert(0, "./");
  }
  folder.write("many.mtl", library);
  const ImportedMesh obj = read("mtllib many.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n", folder.path());
  std::size_t copies = 0;
  for (const Material& material : obj.mesh.materials)
    copies += material.base_color_image.empty() ? 0 : 1;
  EXPECT_EQ(copies, 1 + (std::size_t{256} << 20) / kSize);
  EXPECT_TRUE(has_note(obj, "left out: used too many times"));
}

TEST(ObjMaterials, NothingOutsideTheFolderIsRead) {
  const TempFolder outer;
  const auto secret = outer.write("secret.mtl", "newmtl a\nKd 0.5 0.5 0.5\n");
  outer.write("secret.png", kTinyPng);
  const auto folder = outer.path() / "in";
  std::filesystem::create_directories(folder);
  std::filesystem::create_symlink(secret, folder / "link.mtl");
  for (const std::string& name :
       {std::string("../secret.mtl"), secret.string(), "file://" + secret.string(), std::string("link.mtl"),
        std::string("..\\secret.mtl"), std::string("http://localhost/secret.mtl")}) {
    const ImportedMesh obj = read("mtllib " + name + "\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n", folder);
    ASSERT_EQ(obj.mesh.materials.size(), 1u) << name;
    EXPECT_NE(obj.mesh.materials[0].base_color, Vec4(0.5f, 0.5f, 0.5f, 1.0f)) << name << " was read";
    EXPECT_TRUE(has_note(obj, "not read")) << name;
  }
  outer.write("in/good.mtl", "newmtl a\nmap_Kd ../secret.png\n");
  const ImportedMesh obj = read("mtllib good.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n", folder);
  EXPECT_TRUE(obj.mesh.materials.at(0).base_color_image.empty());
  EXPECT_TRUE(has_note(obj, "picture \"../secret.png\""));
}

TEST(ObjMaterials, LibrariesNamedOverAndOverAreReadInTime) {
  const TempFolder folder;
  std::string library;
  for (int i = 0; i < 30000; ++i)
    library += "newmtl material " + std::to_string(i) + "\nKd 0.5 0.25 0.125\n";
  folder.write("much.mtl", library);
  std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  std::string here = "./";
  for (int i = 0; i < 1000; ++i, here += i % 100 == 0 ? "./" : "")
    text += "mtllib much.mtl\nmtllib " + here + "much.mtl\nmtllib %6duch.mtl\nmtllib much.mtl " + here + "%6Duch.mtl\n";
  const ImportedMesh obj = read(text + "usemtl material 7\nf 1 2 3\n", folder.path());
  EXPECT_EQ(obj.mesh.materials.size(), 30000u);
  EXPECT_EQ(obj.mesh.materials.at(7).base_color, Vec4(0.5f, 0.25f, 0.125f, 1));
  EXPECT_TRUE(obj.notes.empty()) << obj.notes.front();
}

TEST(ObjMaterials, ALibraryThatIsNotThereIsNotedOnce) {
  const TempFolder folder;
  const ImportedMesh obj =
      read("mtllib lost.mtl\nmtllib lost.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n", folder.path());
  EXPECT_EQ(obj.notes.size(), 1u);
}

TEST(ObjMaterials, SpellingsOfOnePictureShareOneBudget) {
  constexpr std::size_t kPictureBytes = std::size_t{32} << 20;
  constexpr std::size_t kSpellings = 12;
  const TempFolder folder;
  std::string picture(kTinyPng);
  picture.resize(kPictureBytes);
  folder.write("p.png", picture);
  std::filesystem::create_symlink("p.png", folder / "link.png");
  std::string library = "newmtl l\nmap_Kd link.png\nnewmtl c\nmap_Kd %70.pn%67\n";
  std::string name = "p.png";
  for (std::size_t i = 2; i < kSpellings; ++i, name = "./" + name)
    library += "newmtl m" + std::to_string(i) + "\nmap_Kd " + name + "\n";
  folder.write("a.mtl", library);
  const ImportedMesh obj = read("mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m2\nf 1 2 3\n", folder.path());
  std::size_t held = 0;
  for (const Material& material : obj.mesh.materials)
    held += material.base_color_image.size();
  EXPECT_EQ(obj.mesh.materials.size(), kSpellings);
  EXPECT_EQ(held, 9 * kPictureBytes) << "the first use, and copies of 256 MiB";
  EXPECT_TRUE(has_note(obj, "used too many times"));
}

TEST(ObjMaterials, ARefusedSpellingDoesNotSpoilAGoodOne) {
  const TempFolder folder;
  folder.write("p.png", kTinyPng);
  const std::string away = (folder / "p.png").string();
  folder.write("a.mtl", "newmtl a\nmap_Kd " + away + "\nnewmtl b\nmap_Kd ./../" + folder.path().filename().string() +
                            "/p.png\nnewmtl c\nmap_Kd p.png\n");
  const ImportedMesh obj = read("mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl c\nf 1 2 3\n", folder.path());
  ASSERT_EQ(obj.mesh.materials.size(), 3u);
  EXPECT_TRUE(obj.mesh.materials[0].base_color_image.empty());
  EXPECT_TRUE(obj.mesh.materials[1].base_color_image.empty());
  EXPECT_EQ(obj.mesh.materials[2].base_color_image.size(), kTinyPng.size());
}

Mesh two_materials() {
  Mesh mesh =
      read("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvt 1 1\nf 1/1 2/2 3/3\nf 2/2 4/4 3/3\n").mesh;
  mesh.materials.resize(3);
  mesh.materials[0].name = "glass\nroof";
  mesh.materials[0].base_color = {0.1f, 0.2f, 0.3f, 0.4f};
  mesh.materials[1].name = "wood";
  mesh.materials[1].roughness = 0.3f;
  mesh.materials[1].metallic = 0.7f;
  const auto png = std::as_bytes(std::span(kTinyPng.data(), kTinyPng.size()));
  mesh.materials[1].base_color_image.assign(png.begin(), png.end());
  mesh.materials[1].base_color_image_mime = "image/png";
  mesh.materials[1].normal_image.assign(png.begin(), png.begin() + 12);
  mesh.materials[1].normal_image_mime = "image/png";
  mesh.materials[2].name = "wood";
  mesh.face_materials = {1, 2};
  return mesh;
}

TEST(ObjMaterials, SurviveTheRoundTrip) {
  const TempFolder folder;
  const Mesh mesh = two_materials();
  const auto files = formats::write_obj(mesh, folder / "my model.obj");
  ASSERT_TRUE(files.has_value());
  ASSERT_EQ(files->size(), 4u);
  EXPECT_EQ((*files)[1].path.filename(), "my model-wood.png");
  EXPECT_EQ((*files)[2].path.filename(), "my model-wood.normal.png");
  EXPECT_EQ((*files)[3].path.filename(), "my model.mtl");
  for (const auto& file : *files)
    folder.write(file.path.filename().string(), file.bytes);
  const ImportedMesh back = read((*files)[0].bytes, folder.path());
  EXPECT_TRUE(back.notes.empty()) << back.notes.front();
  ASSERT_EQ(back.mesh.materials.size(), 3u);
  EXPECT_EQ(back.mesh.materials[0].name, "glass_roof");
  EXPECT_EQ(back.mesh.materials[2].name, "wood_3") << "two materials of one name must stay apart";
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(back.mesh.materials[i].base_color, mesh.materials[i].base_color);
    EXPECT_EQ(back.mesh.materials[i].roughness, mesh.materials[i].roughness);
    EXPECT_EQ(back.mesh.materials[i].metallic, mesh.materials[i].metallic);
    EXPECT_EQ(back.mesh.materials[i].base_color_image, mesh.materials[i].base_color_image);
    EXPECT_EQ(back.mesh.materials[i].normal_image, mesh.materials[i].normal_image);
  }
  EXPECT_EQ(back.mesh.face_materials, mesh.face_materials);
}

TEST(ObjWrite, NamesFilesBesideTheModelAsItsReaderFollowsThem) {
  for (const char* const name : {"a:b.obj", "a\\b.obj", "b\\.obj", "50%41.obj", "50%00.obj", "two\nlines\tand.obj",
                                 "  in front.obj", "-s 2 2.obj", "a#b.obj", "plain name.obj"}) {
    SCOPED_TRACE(name);
    const TempFolder folder;
    const Mesh mesh = two_materials();
    const auto files = formats::write_obj(mesh, folder / name);
    ASSERT_TRUE(files.has_value());
    EXPECT_EQ(files->front().path, folder / name);
    for (const auto& file : *files)
      folder.write(file.path.filename().string(), file.bytes);
    const ImportedMesh back = read(files->front().bytes, folder.path());
    EXPECT_TRUE(back.notes.empty()) << back.notes.front();
    ASSERT_EQ(back.mesh.materials.size(), 3u);
    EXPECT_EQ(back.mesh.materials[1].base_color_image, mesh.materials[1].base_color_image);
  }
}

TEST(ObjWrite, GivesStandardOutputOneFile) {
  const auto files = formats::write_obj(two_materials(), "-");
  ASSERT_TRUE(files.has_value());
  EXPECT_EQ(files->size(), 1u);
  EXPECT_EQ((*files)[0].bytes.find("mtllib"), std::string::npos);
}

TEST(ObjWrite, KeepsIndexedAttributesAndColors) {
  Mesh mesh = read(
                  "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nv 1 1 0 1 1 1\nvn 0 0 1\nvn 0 1 0\nf 1//1 2//2 3//1\nf "
                  "2//1 4//1 3//2\n")
                  .mesh;
  const auto files = formats::write_obj(mesh, "m.obj");
  ASSERT_TRUE(files.has_value());
  const Mesh back = read((*files)[0].bytes).mesh;
  EXPECT_EQ(back.normals.values, mesh.normals.values);
  EXPECT_EQ(back.normals.indices, mesh.normals.indices);
  EXPECT_EQ(back.colors.values, mesh.colors.values);
  EXPECT_EQ((*files)[0].bytes, (*formats::write_obj(mesh, "m.obj"))[0].bytes);
}

TEST(ObjWrite, RepeatsVerticesWhoseCornersDifferInColor) {
  Mesh mesh = read("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n").mesh;
  mesh.colors.values = {{1, 0, 0, 1}, {0, 0, 1, 1}};
  mesh.colors.indices = {0, 0, 0, 1, 1, 1};
  const auto files = formats::write_obj(mesh, "m.obj");
  ASSERT_TRUE(files.has_value());
  const Mesh back = read((*files)[0].bytes).mesh;
  EXPECT_EQ(back.positions.size(), 6u);
  for (FaceId f = 0; f < 2; ++f) {
    for (int c = 0; c < 3; ++c) {
      EXPECT_EQ(back.corner(back.colors, f, c), mesh.corner(mesh.colors, f, c));
      const auto k = static_cast<std::size_t>(c);
      EXPECT_EQ(bits(back.positions[back.faces[f][k]]), bits(mesh.positions[mesh.faces[f][k]]));
    }
  }
}

TEST(ObjWrite, RefusesCoordinatesThatAreNotFinite) {
  Mesh mesh = two_materials();
  mesh.positions[2].y = std::numeric_limits<float>::quiet_NaN();
  const auto files = formats::write_obj(mesh, "m.obj");
  ASSERT_FALSE(files.has_value());
  EXPECT_EQ(files.error().code, ErrorCode::kInvalidArgument);
  EXPECT_EQ(files.error().where, "vertex 2");
}

}  // namespace
}  // namespace limn
