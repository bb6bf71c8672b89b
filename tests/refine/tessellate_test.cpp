#include "limn/refine/tessellate.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <map>

#include "limn/base/parallel.h"
#include "limn/base/random.h"
#include "limn/mesh/normals.h"
#include "limn/mesh/shapes.h"
#include "limn/refine/refine.h"

#include "refine/random_levels.h"
#include "support/checks.h"
#include "support/stable.h"

namespace limn {
namespace {

Mesh shape(Shape kind, std::size_t faces) {
  return make_shape(kind, {.faces = faces}).value();
}

Refinement refined(const Mesh& mesh, std::uint64_t seed, int max_level = 3, Blend blend = Blend::kSurplus) {
  const Refiner refiner = Refiner::create(mesh, {.blend = blend}).value();
  Random random(seed);
  return refiner.refine_with(random_levels(random, refiner.topology().edge_count(), max_level)).value();
}

/// Area summed with its direction: what any tessellation with the same border must keep.
DVec3 area_vector(const Mesh& mesh) {
  DVec3 sum(0);
  for (const Triangle& t : mesh.faces) {
    const DVec3 a = mesh.positions[t[0]];
    sum += 0.5 * glm::cross(DVec3(mesh.positions[t[1]]) - a, DVec3(mesh.positions[t[2]]) - a);
  }
  return sum;
}

/// Whether two faces have two edges in common, as those back to back do: what their insides share then cannot be told
/// from what they share along an edge.
bool has_faces_back_to_back(const Topology& topology) {
  std::map<std::pair<FaceId, FaceId>, int> common;
  for (EdgeId e = 0; e < topology.edge_count(); ++e) {
    const auto faces = topology.edge_faces(e);
    for (std::size_t i = 1; i < faces.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (++common[std::minmax(faces[i], faces[j])] == 2) return true;
      }
    }
  }
  return false;
}

TEST(Tessellate, KeepsClosedMeshesClosedAndOpenOnesOpenAlongTheirOwnRim) {
  int tried = 0;
  for (const test::StableMesh& item : test::awkward_meshes()) {
    const auto refiner = Refiner::create(item.mesh);
    if (!refiner || has_faces_back_to_back(refiner->topology())) continue;
    ++tried;
    const Topology& before = refiner->topology();
    Random random(1);
    for (int round = 0; round < 3; ++round) {
      const std::vector<float> levels = random_levels(random, before.edge_count(), 3);
      const Refinement result = refiner->refine_with(levels).value();
      test::expect_well_formed(result.mesh);
      // Connectivity by index: every point of a shared edge is stored once, so no position needs welding.
      std::map<std::pair<VertexId, VertexId>, int> uses;
      for (const Triangle& t : result.mesh.faces) {
        for (std::size_t c = 0; c < 3; ++c)
          ++uses[std::minmax(t[c], t[(c + 1) % 3])];
      }
      // Each input edge with n faces becomes 2^t segments with n faces; segments inside faces have two.
      std::map<int, std::size_t> segments_with, expected;
      for (const auto& [ends, count] : uses)
        ++segments_with[count];
      for (std::size_t e = 0; e < before.edge_count(); ++e) {
        int t = 0;
        for (const FaceId f : before.edge_faces(static_cast<EdgeId>(e)))
          t = std::max<int>(t, result.face_level[f]);
        const auto faces = static_cast<int>(before.edge_faces(static_cast<EdgeId>(e)).size());
        if (faces != 2) expected[faces] += std::size_t{1} << t;
      }
      segments_with.erase(2);
      EXPECT_EQ(segments_with, expected) << item.name;
    }
  }
  EXPECT_GE(tried, 12);
}

TEST(Tessellate, KeepsTheWindingAndTheNormalsSideOfItsInput) {
  for (const Shape kind : {Shape::kIcosphere, Shape::kTorus, Shape::kCube, Shape::kHoles3}) {
    const Refinement result = refined(shape(kind, 600), 2);
    test::expect_closed(result.mesh);
    std::size_t wrong = 0;
    const std::vector<Vec3> normals = face_normals(result.mesh);
    for (FaceId f = 0; f < result.mesh.faces.size(); ++f) {
      for (int c = 0; c < 3; ++c)
        wrong += glm::dot(result.mesh.corner(result.mesh.normals, f, c), normals[f]) < -0.2f;
    }
    EXPECT_EQ(wrong, 0u);
    EXPECT_GT(test::signed_volume(result.mesh), 0.0);
  }
}

TEST(Tessellate, GivesTheTriangleCountsItsLevelsSay) {
  const Mesh mesh = shape(Shape::kTorus, 200);
  const Refiner refiner = Refiner::create(mesh).value();
  for (int m = 0; m <= 4; ++m) {
    const std::vector<float> levels(refiner.topology().edge_count(), static_cast<float>(m));
    EXPECT_EQ(refiner.refine_with(levels).value().mesh.faces.size(), mesh.faces.size() << (2 * m));
  }
}

TEST(Tessellate, LeavesAFlatMeshWhereItIs) {
  const Mesh mesh = shape(Shape::kCube, 48);
  for (const Blend blend : {Blend::kSurplus, Blend::kPaper}) {
    const Refinement result = refined(mesh, 4, 4, blend);
    const float half = face_bounds(mesh).high.x;
    for (const Vec3& p : result.mesh.positions) {
      EXPECT_NEAR(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}), half, 1e-6f);
    }
    EXPECT_NEAR(test::signed_volume(result.mesh), 8.0 * half * half * half, 1e-5);
  }
}

TEST(Tessellate, CutsTJunctionsWithoutMovingTheSurface) {
  // A sheet's border at level 0 stays as it is whatever happens inside: the area vector, a line integral along it, too.
  const Mesh mesh = shape(Shape::kSheet, 400);
  const Refiner refiner = Refiner::create(mesh).value();
  Random random(5);
  std::vector<float> levels = random_levels(random, refiner.topology().edge_count(), 4);
  for (std::size_t e = 0; e < levels.size(); ++e) {
    if (refiner.topology().edge_class[e] == EdgeClass::kBoundary) levels[e] = 0;
  }
  const Refinement result = refiner.refine_with(levels).value();
  EXPECT_LT(glm::length(area_vector(result.mesh) - area_vector(mesh)), 1e-4);
}

TEST(Tessellate, MeetsASphereMoreCloselyLevelByLevel) {
  const Refiner refiner = Refiner::create(shape(Shape::kIcosphere, 320)).value();
  double last = 1;
  for (int m = 0; m <= 3; ++m) {
    const std::vector<float> levels(refiner.topology().edge_count(), static_cast<float>(m));
    const Mesh mesh = refiner.refine_with(levels).value().mesh;
    double worst = 0;
    for (const Triangle& t : mesh.faces) {
      const Vec3 middle = (mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]) / 3.0f;
      worst = std::max(worst, std::abs(1.0 - double{glm::length(middle)}));
    }
    EXPECT_LT(worst, last * (m < 2 ? 0.35 : 0.6));  // the patches themselves are 7e-4 away
    last = worst;
  }
}

TEST(Tessellate, KeepsSeamsAsSeamsAndSharesWhatIsShared) {
  const Mesh mesh = shape(Shape::kTorus, 400);
  const Refiner refiner = Refiner::create(mesh).value();
  const std::vector<float> levels(refiner.topology().edge_count(), 2.0f);
  const Mesh result = refiner.refine_with(levels).value().mesh;
  // Normals are smooth all over: one a position. Texture coordinates have seams: a few more than positions.
  EXPECT_EQ(result.normals.values.size() - mesh.normals.values.size(),
            result.positions.size() - refiner.mesh().positions.size());
  EXPECT_GT(result.uvs.values.size(), result.positions.size());
  EXPECT_LT(result.uvs.values.size(), result.positions.size() * 5 / 4);
  // No triangle reaches across the texture.
  for (FaceId f = 0; f < result.faces.size(); ++f) {
    for (int c = 0; c < 3; ++c) {
      const Vec2 d = result.corner(result.uvs, f, c) - result.corner(result.uvs, f, (c + 1) % 3);
      EXPECT_LT(std::max(std::abs(d.x), std::abs(d.y)), 0.1f);
    }
  }
}

TEST(Tessellate, KeepsHardEdgesHard) {
  const Mesh mesh = shape(Shape::kCube, 12);
  const Refinement result = refined(mesh, 6, 3);
  for (FaceId f = 0; f < result.mesh.faces.size(); ++f) {
    const Vec3 expected = face_normals(mesh)[result.source_face[f]];
    for (int c = 0; c < 3; ++c) {
      EXPECT_LT(glm::length(result.mesh.corner(result.mesh.normals, f, c) - expected), 1e-5f);
    }
  }
}

TEST(Tessellate, CarriesMaterialsAndNamesTheSourceOfEachFace) {
  Mesh mesh = shape(Shape::kIcosphere, 80);
  mesh.materials.resize(2);
  mesh.face_materials.resize(mesh.faces.size());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f)
    mesh.face_materials[f] = f % 2;
  const Refinement result = refined(mesh, 7);
  ASSERT_EQ(result.mesh.face_materials.size(), result.mesh.faces.size());
  for (std::size_t f = 0; f < result.mesh.faces.size(); ++f) {
    EXPECT_EQ(result.mesh.face_materials[f], result.source_face[f] % 2);
  }
  EXPECT_EQ(result.mesh.materials.size(), 2u);
}

TEST(Tessellate, IsTheSameForAnyNumberOfThreads) {
  const Mesh mesh = shape(Shape::kAsteroid, 20000);
  const View view{{Vec3(0, 0, 4), false}, 500};
  const Refinement many = refine(mesh, view).value();
  const ThreadLimit one(1);
  test::expect_same_bits(many.mesh, refine(mesh, view).value().mesh);
}

TEST(Refine, RefusesWhatItCannotDoAndSaysWhy) {
  EXPECT_EQ(refine(Mesh{}, {}).error().code, ErrorCode::kUnsuitable);
  Mesh degenerate;
  degenerate.positions = {{0, 0, 0}, {1, 0, 0}};
  degenerate.faces = {{0, 1, 1}};
  EXPECT_EQ(refine(degenerate, {}).error().code, ErrorCode::kUnsuitable);
  const Mesh mesh = shape(Shape::kTorus, 200);
  RefineOptions options;
  options.levels = {.criterion = Criterion::kUniform, .max_level = 8};
  options.max_triangles = 1000;
  const auto too_many = refine(mesh, {}, options);
  ASSERT_FALSE(too_many);
  EXPECT_EQ(too_many.error().code, ErrorCode::kUnsuitable);
  EXPECT_NE(too_many.error().message.find("more than 1000"), std::string::npos);
  options.max_triangles = 100'000'000;
  options.levels.max_level = 2;
  options.progress = [](std::string_view stage, double) { return stage != "tessellate"; };
  EXPECT_EQ(refine(mesh, {}, options).error().code, ErrorCode::kCancelled);
  options = {};
  options.crease_angle_rad = NAN;
  EXPECT_EQ(refine(mesh, {}, options).error().code, ErrorCode::kInvalidArgument);
}

TEST(Refine, RefusesCoordinatesAndTagsThatWouldNotStayFinite) {
  Mesh mesh = shape(Shape::kTetrahedron, 4);
  for (Vec3& p : mesh.positions)
    p *= 2e38f;
  EXPECT_EQ(refine(mesh, {}, {.levels = {.criterion = Criterion::kUniform}}).error().code, ErrorCode::kUnsuitable);
  mesh = shape(Shape::kTetrahedron, 4);
  mesh.tags.assign(mesh.positions.size(), NAN);
  EXPECT_EQ(refine(mesh, {}, {.levels = {.criterion = Criterion::kTags}}).error().code, ErrorCode::kUnsuitable);
  mesh = {};
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  mesh.faces = {{0, 1, 2}};
  EXPECT_EQ(refine(mesh, {}).error().code, ErrorCode::kUnsuitable);
}

TEST(Tessellate, OfNothingIsNothing) {
  Mesh mesh;
  mesh.normals.values = {Vec3(0, 0, 1)};
  EXPECT_EQ(tessellate(mesh, build_topology(mesh), {}, {}).value().mesh.faces.size(), 0u);
}

TEST(Refine, RefinesTheOutlineAndLittleElse) {
  const Mesh mesh = shape(Shape::kIcosphere, 5000);
  const Refinement result = refine(mesh, {{Vec3(0, 0, 5), false}, 0}).value();
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Vec3 middle = glm::normalize(mesh.positions[mesh.faces[f][0]]);
    if (middle.z > 0.8f || middle.z < -0.5f) {
      EXPECT_EQ(result.face_level[f], 0);
    }
    if (std::abs(middle.z - 0.2f) < 0.02f) {
      EXPECT_EQ(result.face_level[f], 3);
    }
  }
}

}  // namespace
}  // namespace limn
