#include "limn/mesh/repair.h"

#include <algorithm>
#include <array>
#include <gtest/gtest.h>
#include <set>
#include <string>
#include <tuple>

#include "limn/base/random.h"
#include "limn/mesh/face_area.h"
#include "limn/mesh/shapes.h"
#include "limn/mesh/validate.h"

#include "support/checks.h"
#include "support/stable.h"

namespace limn {
namespace {

using test::StableMesh;

MeshReport report_of(const Mesh& mesh) {
  return validate(mesh, build_topology(mesh));
}

Mesh stable_mesh(std::string_view name) {
  for (StableMesh& entry : test::awkward_meshes()) {
    if (entry.name == name) return std::move(entry.mesh);
  }
  ADD_FAILURE() << name;
  return {};
}

bool mentions(const Repair& repaired, std::string_view text) {
  return std::any_of(repaired.changes.begin(), repaired.changes.end(),
                     [&](const std::string& change) { return change.find(text) != std::string::npos; });
}

TEST(Repair, LeavesGoodMeshesAsTheyAre) {
  for (const ShapeInfo& info : shapes()) {
    SCOPED_TRACE(info.name);
    const Result<Mesh> mesh = make_shape(info.shape);
    ASSERT_TRUE(mesh.has_value());
    const Repair repaired = repair(*mesh);
    EXPECT_TRUE(repaired.changes.empty());
    test::expect_same_bits(repaired.mesh, *mesh);
  }
}

TEST(Repair, IsIdempotentWellFormedAndNeverMovesAVertex) {
  for (const StableMesh& entry : test::awkward_meshes()) {
    SCOPED_TRACE(entry.name);
    const Repair once = repair(entry.mesh);
    test::expect_well_formed(once.mesh);
    const Repair twice = repair(once.mesh);
    EXPECT_TRUE(twice.changes.empty()) << twice.changes.front();
    test::expect_same_bits(twice.mesh, once.mesh);
    const auto less = [](const Vec3& a, const Vec3& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); };
    const std::set<Vec3, decltype(less)> before(entry.mesh.positions.begin(), entry.mesh.positions.end(), less);
    for (const Vec3& p : once.mesh.positions)
      EXPECT_EQ(before.count(p), 1u);
  }
}

TEST(Repair, LeavesNothingItPromisesToRemove) {
  for (const StableMesh& entry : test::awkward_meshes()) {
    SCOPED_TRACE(entry.name);
    const MeshReport report = report_of(repair(entry.mesh).mesh);
    EXPECT_EQ(report.degenerate_faces, 0u);
    EXPECT_EQ(report.unused_vertices, 0u);
    const bool one_sided = entry.name == "Moebius band" || entry.name == "Klein bottle";
    EXPECT_EQ(report.inconsistent_edges > 0, one_sided);
    EXPECT_EQ(report.components, report_of(entry.mesh).components);
  }
}

TEST(Repair, FlippedFacesAgreeWithTheirNeighboursAgain) {
  const Repair repaired = repair(stable_mesh("flipped face"));
  EXPECT_EQ(repaired.changes, std::vector<std::string>{"turned 1 face to agree with their neighbours"});
  test::expect_closed(repaired.mesh);
  EXPECT_GT(test::signed_volume(repaired.mesh), 3);
}

TEST(Repair, ManyFlippedFacesStillWindOutwards) {
  Mesh mesh = stable_mesh("torus");
  mesh.normals = {};
  mesh.uvs = {};
  const double volume = test::signed_volume(mesh);
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    if (face % 5 != 0) std::swap(mesh.faces[face][0], mesh.faces[face][1]);  // the majority winds inwards
  }
  const Repair repaired = repair(mesh);
  test::expect_closed(repaired.mesh);
  EXPECT_NEAR(test::signed_volume(repaired.mesh), volume, 1e-6);
  EXPECT_TRUE(mentions(repaired, "turned 160 faces"));
}

TEST(Repair, SolidsInsideOutAreTurned) {
  const Repair repaired = repair(stable_mesh("inside out"));
  EXPECT_EQ(repaired.changes, std::vector<std::string>{"turned 12 faces of 1 closed component outwards"});
  EXPECT_DOUBLE_EQ(test::signed_volume(repaired.mesh), 8);
}

TEST(Repair, WallsOfCavitiesAreLeftAlone) {
  for (const char* name : {"shell with a cavity", "shell in a shell"}) {
    const Mesh mesh = stable_mesh(name);
    const Repair repaired = repair(mesh);
    EXPECT_TRUE(repaired.changes.empty()) << name;
    test::expect_same_bits(repaired.mesh, mesh);
  }
}

TEST(Repair, OneSidedSurfacesAreLeftAlone) {
  for (const char* name : {"Moebius band", "Klein bottle"})
    EXPECT_TRUE(repair(stable_mesh(name)).changes.empty()) << name;
}

TEST(Repair, RemovesDegenerateFacesCopiesAndStrayVertices) {
  const Repair cube = repair(stable_mesh("degenerate faces"));
  EXPECT_EQ(cube.changes, (std::vector<std::string>{"removed 3 faces without area", "removed 1 unused vertex"}));
  EXPECT_EQ(cube.mesh.faces.size(), 12u);
  const Repair copies = repair(stable_mesh("duplicate faces"));
  EXPECT_EQ(copies.changes, std::vector<std::string>{"removed 2 copies of other faces"});
  EXPECT_EQ(copies.mesh.faces.size(), 5u);  // the one turned over is the back of a face, not a copy of it
  const Repair stray = repair(stable_mesh("stray vertices"));
  EXPECT_EQ(stray.changes, std::vector<std::string>{"removed 2 unused vertices"});
  test::expect_closed(stray.mesh);
}

TEST(Repair, FacesWithoutAreaStayWhereTheyHoldTheSurfaceTogether) {
  const Mesh stitched = stable_mesh("collinear face");
  EXPECT_TRUE(repair(stitched).changes.empty());
  Mesh loose = stitched;
  loose.faces.pop_back();  // now the collinear face lies at the boundary
  const Repair repaired = repair(loose);
  EXPECT_TRUE(mentions(repaired, "removed 1 face without area"));
  EXPECT_EQ(report_of(repaired.mesh).zero_area_faces, 0u);
}

/// Faces without area taken off one round at a time, the topology built anew for each.
Mesh slowly_peeled(Mesh mesh) {
  for (;;) {
    const Topology topology = build_topology(mesh);
    std::vector<Triangle> kept;
    for (FaceId face = 0; face < mesh.faces.size(); ++face) {
      const std::array<EdgeId, 3>& edges = topology.face_edges[face];
      if (edges[0] == kInvalidId) continue;
      const bool sliver = twice_area_vector(mesh, face) == DVec3(0.0);
      const bool loose = std::any_of(edges.begin(), edges.end(), [&](EdgeId edge) {
        return topology.edge_class[edge] == EdgeClass::kBoundary ||
               topology.edge_class[edge] == EdgeClass::kNonManifold;
      });
      if (!sliver || !loose) kept.push_back(mesh.faces[face]);
    }
    if (kept.size() == mesh.faces.size()) return mesh;
    mesh.faces = std::move(kept);
  }
}

void expect_peels_as_the_oracle(Mesh mesh) {
  mesh.normals = {};
  mesh.uvs = {};
  mesh.colors = {};
  mesh.face_materials = {};
  const Mesh peeled = slowly_peeled(mesh);
  const Repair repaired = repair(mesh);
  const std::size_t gone = mesh.faces.size() - peeled.faces.size();
  EXPECT_EQ(mentions(repaired, "without area"), gone > 0);
  EXPECT_EQ(mentions(repaired, "removed " + std::to_string(gone) + " face"), gone > 0);
  test::expect_same_bits(repaired.mesh, repair(peeled).mesh);
}

TEST(Repair, TakesOffTheSameFacesAsTheSlowOracle) {
  for (const StableMesh& entry : test::awkward_meshes()) {
    SCOPED_TRACE(entry.name);
    expect_peels_as_the_oracle(entry.mesh);
  }
  Random random(17);
  for (int round = 0; round < 600; ++round) {
    SCOPED_TRACE(round);
    Mesh mesh;
    const std::uint64_t height = 1 + random.below(2);
    for (int i = 0; i < 12; ++i) {
      mesh.positions.emplace_back(static_cast<float>(random.below(4)), static_cast<float>(random.below(height + 1)),
                                  static_cast<float>(random.below(height)));
    }
    const std::uint64_t faces = 4 + random.below(40);
    for (std::uint64_t i = 0; i < faces; ++i) {
      const auto vertex = [&] { return static_cast<VertexId>(random.below(12)); };
      mesh.faces.push_back({vertex(), vertex(), vertex()});
    }
    expect_peels_as_the_oracle(mesh);
  }
}

TEST(Repair, PeelsALongSeamOfFacesWithoutAreaInTime) {
  // Flat on a line, each held by the two beside it and by a face with area: only the ends are loose, round by round.
  constexpr VertexId kSlivers = 100000;
  Mesh mesh;
  for (VertexId i = 0; i < kSlivers + 2; ++i)
    mesh.positions.emplace_back(static_cast<float>(i), 0, 0);
  for (VertexId i = 0; i < kSlivers; ++i) {
    mesh.positions.emplace_back(static_cast<float>(i + 1), 1, 0);
    mesh.faces.push_back({i, i + 1, i + 2});
    mesh.faces.push_back({i, i + 2, kSlivers + 2 + i});
  }
  const Repair repaired = repair(mesh);
  EXPECT_TRUE(mentions(repaired, "removed 100000 faces without area"));
  EXPECT_EQ(repaired.mesh.faces.size(), kSlivers);
}

TEST(Repair, ManyFacesWithoutAreaAroundOneEdgeGoInTime) {
  constexpr VertexId kSlivers = 100000;
  Mesh mesh;
  mesh.positions = {Vec3(0), Vec3(-1, 0, 0), Vec3(0, 1, 0)};
  mesh.faces = {{0, 1, 2}};
  for (VertexId i = 0; i < kSlivers; ++i) {
    mesh.positions.emplace_back(static_cast<float>(i + 1), 0, 0);
    mesh.faces.push_back({1, 0, i + 3});
  }
  EXPECT_EQ(repair(mesh).mesh.faces, (std::vector<Triangle>{{0, 1, 2}}));
}

TEST(Repair, AttributesFollowTheirFaces) {
  Mesh mesh = stable_mesh("every attribute");
  const Mesh original = mesh;
  // A stray vertex in front, a useless face in front, and one face turned with its corners.
  mesh.positions.insert(mesh.positions.begin(), Vec3(9));
  mesh.colors.values.insert(mesh.colors.values.begin(), Vec4(0));
  mesh.tags.insert(mesh.tags.begin(), 7.0f);
  for (Triangle& t : mesh.faces)
    t = {t[0] + 1, t[1] + 1, t[2] + 1};
  mesh.faces.insert(mesh.faces.begin(), Triangle{1, 1, 2});
  mesh.face_materials.insert(mesh.face_materials.begin(), 1);
  for (auto* indices : {&mesh.normals.indices, &mesh.uvs.indices}) {
    indices->insert(indices->begin(), 3, 0);
    std::swap((*indices)[3 * 10 + 1], (*indices)[3 * 10 + 2]);
  }
  std::swap(mesh.faces[10][1], mesh.faces[10][2]);
  const Repair repaired = repair(mesh);
  EXPECT_EQ(repaired.changes.size(), 3u);
  test::expect_same_bits(repaired.mesh, original);
}

TEST(Repair, NormalsOfTurnedFacesPointToTheFront) {
  Mesh mesh = stable_mesh("sphere with a texture seam");
  const Mesh original = mesh;
  for (Triangle& t : mesh.faces)
    std::swap(t[1], t[2]);
  mesh.uvs = {};
  for (Vec3& n : mesh.normals.values)
    n = -n;  // as a program that mirrors a model leaves it
  const Repair repaired = repair(mesh);
  test::expect_well_formed(repaired.mesh);
  EXPECT_GT(test::worst_normal_agreement(repaired.mesh), 0.9);
  Mesh wound_only = original;  // winding alone wrong: the normals were right and stay
  wound_only.uvs = {};
  for (Triangle& t : wound_only.faces)
    std::swap(t[1], t[2]);
  const Repair rewound = repair(wound_only);
  EXPECT_EQ(rewound.mesh.normals.values, original.normals.values);
  EXPECT_TRUE(rewound.mesh.normals.indices.empty());
}

}  // namespace
}  // namespace limn
