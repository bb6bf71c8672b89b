#include "limn/mesh/export.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <map>
#include <string>

#include "limn/mesh/formats/formats.h"

#include "support/mesh_bits.h"
#include "support/stable.h"
#include "support/temp_folder.h"

namespace limn {
namespace {

using test::corner_positions;
using test::corner_values;
using test::same_bits;
using test::slurp;
using test::TempFolder;

TEST(WriteMesh, WritesWhatReadMeshReadsBack) {
  const TempFolder folder;
  const Mesh mesh = test::awkward_tetrahedron(false);
  for (const char* const name : {"a.ply", "a.stl", "a.off"}) {
    for (const bool ascii : {false, true}) {
      ASSERT_TRUE(write_mesh(mesh, folder / name, {.format = MeshFormat::kUnknown, .ascii = ascii, .progress = {}}));
      const auto back = read_mesh(folder / name);
      ASSERT_TRUE(back) << format_error(back.error());
      EXPECT_TRUE(same_bits(corner_positions(mesh), corner_positions(back->mesh))) << name;
    }
  }
}

TEST(WriteMesh, NamesTheFormatsItKnowsWhenThereIsNone) {
  const TempFolder folder;
  for (const char* const name : {"a", "a.3ds", "-"}) {
    const auto done = write_mesh(test::awkward_tetrahedron(false), name == std::string("-") ? "-" : folder / name);
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().code, ErrorCode::kInvalidArgument);
    EXPECT_NE(done.error().remedy.find(".ply"), std::string::npos);
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(WriteMesh, LeavesNothingBehindWhenItFailsOrIsStopped) {
  const TempFolder folder;
  const Mesh mesh = test::awkward_tetrahedron(true);
  for (const char* const name : {"absent/a.ply", "absent/a.obj"}) {
    const auto done = write_mesh(mesh, folder / name);
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().code, ErrorCode::kUnwritable);
  }
  ExportOptions stopped;
  stopped.progress = [](std::string_view, double share) { return share < 0.25; };
  const auto done = write_mesh(mesh, folder / "a.ply", stopped);
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().code, ErrorCode::kCancelled);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(WriteMesh, PutsSeveralFilesInPlaceTogetherOrNotAtAll) {
  const TempFolder folder;
  Mesh mesh = test::awkward_tetrahedron(false);
  mesh.materials.resize(1);
  mesh.materials[0].name = "red";
  folder.write("a.obj", "old");
  std::filesystem::permissions(folder / "a.obj", std::filesystem::perms::owner_all);
  ASSERT_TRUE(write_mesh(mesh, folder / "a.obj"));
  EXPECT_NE(slurp(folder / "a.obj"), "old");
  EXPECT_TRUE(std::filesystem::is_regular_file(folder / "a.mtl"));
  EXPECT_EQ(std::filesystem::status(folder / "a.obj").permissions(), std::filesystem::perms::owner_all);
  // The MTL's place is taken by a folder: the OBJ must stay as it is.
  folder.write("b.obj", "old");
  folder.write("b.mtl/in the way", "");
  ASSERT_FALSE(write_mesh(mesh, folder / "b.obj"));
  EXPECT_EQ(slurp(folder / "b.obj"), "old");
  const auto entries = std::distance(std::filesystem::directory_iterator(folder.path()), {});
  EXPECT_EQ(entries, 4);
}

/// The obvious way: a map from everything a corner carries to its vertex.
std::size_t distinct_corners(const Mesh& mesh) {
  std::map<std::string, int> seen;
  std::vector<bool> used(mesh.positions.size());
  for (FaceId face = 0; face < mesh.faces.size(); ++face) {
    for (int c = 0; c < 3; ++c) {
      std::string key;
      const VertexId vertex = mesh.faces[face][static_cast<std::size_t>(c)];
      test::append_bytes(key, vertex);
      if (!mesh.normals.empty()) test::append_bytes(key, mesh.corner(mesh.normals, face, c));
      if (!mesh.uvs.empty()) test::append_bytes(key, mesh.corner(mesh.uvs, face, c));
      if (!mesh.colors.empty()) test::append_bytes(key, mesh.corner(mesh.colors, face, c));
      seen[key] = 1;
      used[vertex] = true;
    }
  }
  return seen.size() + static_cast<std::size_t>(std::count(used.begin(), used.end(), false));
}

void expect_split_well(const Mesh& mesh) {
  const VertexMesh split = one_value_per_vertex(mesh);
  ASSERT_EQ(split.source.size(), split.positions.size());
  for (std::size_t i = 0; i < split.positions.size(); ++i) {
    if (i < mesh.positions.size()) {
      EXPECT_EQ(split.source[i], i);
    }
  }
  Mesh flat;
  flat.positions = split.positions;
  flat.faces = split.faces;
  flat.normals.values = split.normals;
  flat.uvs.values = split.uvs;
  flat.colors.values = split.colors;
  EXPECT_TRUE(same_bits(corner_positions(mesh), corner_positions(flat)));
  EXPECT_TRUE(same_bits(corner_values(mesh, mesh.normals), corner_values(flat, flat.normals)));
  EXPECT_TRUE(same_bits(corner_values(mesh, mesh.uvs), corner_values(flat, flat.uvs)));
  EXPECT_TRUE(same_bits(corner_values(mesh, mesh.colors), corner_values(flat, flat.colors)));
}

TEST(OneValuePerVertex, RepeatsVerticesOnlyWhereCornersDiffer) {
  const Mesh seams = test::awkward_tetrahedron(true);
  expect_split_well(seams);
  EXPECT_EQ(one_value_per_vertex(seams).positions.size(), distinct_corners(seams));
  expect_split_well(test::awkward_tetrahedron(false));
  EXPECT_EQ(one_value_per_vertex(test::awkward_tetrahedron(false)).positions.size(), 4u);
  for (const test::StableMesh& entry : test::awkward_meshes()) {
    SCOPED_TRACE(entry.name);
    expect_split_well(entry.mesh);
  }
}

TEST(OneValuePerVertex, SplitsAFanOfManyDifferentCornersInLinearTime) {
  constexpr VertexId kFaces = 200'000;
  Mesh mesh;
  mesh.positions.assign(kFaces + 2, Vec3(0.0f));
  for (VertexId face = 0; face < kFaces; ++face) {
    mesh.faces.push_back({0, face + 1, face + 2});
    mesh.uvs.values.emplace_back(static_cast<float>(face), 0.0f);
    mesh.uvs.indices.insert(mesh.uvs.indices.end(), {face, 0, 0});
  }
  const VertexMesh split = one_value_per_vertex(mesh);
  EXPECT_EQ(split.positions.size(), distinct_corners(mesh));
}

}  // namespace
}  // namespace limn
