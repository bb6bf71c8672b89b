#include "limn/mesh/shapes.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <set>
#include <string>

#include "limn/base/parallel.h"
#include "limn/base/random.h"
#include "limn/mesh/shapes/asteroid.h"
#include "limn/mesh/shapes/noise.h"
#include "limn/mesh/topology.h"
#include "limn/mesh/validate.h"

#include "support/checks.h"

namespace limn {
namespace {

/// What is true of a shape at every face count.
struct Expected {
  Shape shape;
  long euler;
  bool closed;
  std::size_t smallest;
  double nearness;         ///< of the face count to a request of a thousand faces or more
  std::size_t exact_from;  ///< faces from which every corner normal looks the way its face does
};

class ShapeTest : public testing::TestWithParam<Expected> {
 protected:
  Mesh make(std::size_t faces, std::uint64_t seed = 1) const {
    Result<Mesh> mesh = make_shape(GetParam().shape, {faces, seed});
    EXPECT_TRUE(mesh.has_value());
    return mesh ? std::move(*mesh) : Mesh{};
  }
  std::vector<std::size_t> counts() const {
    std::vector<std::size_t> all;
    for (const std::size_t count : {20u, 33u, 145u, 400u, 450u, 511u, 777u, 1000u, 2500u, 6001u, 30000u}) {
      if (count >= GetParam().smallest) all.push_back(count);
    }
    all.push_back(GetParam().smallest);
    all.push_back(0);  // the shape's own
    return all;
  }
};

TEST_P(ShapeTest, HasTheTopologyItShouldAtEveryFaceCount) {
  for (const std::size_t count : counts()) {
    SCOPED_TRACE(count);
    const Mesh mesh = make(count);
    test::expect_well_formed(mesh);
    const MeshReport report = validate(mesh, build_topology(mesh));
    EXPECT_EQ(report.closed, GetParam().closed);
    EXPECT_EQ(report.euler_characteristic, GetParam().euler);
    EXPECT_EQ(report.boundary_loops, GetParam().closed ? 0u : 1u);
    EXPECT_EQ(report.components, 1u);
    EXPECT_EQ(report.non_manifold_edges + report.inconsistent_edges + report.non_manifold_vertices, 0u);
    EXPECT_EQ(report.degenerate_faces + report.zero_area_faces + report.duplicate_faces, 0u);
    EXPECT_EQ(report.unused_vertices, 0u);
    EXPECT_EQ(report.welded_vertices, report.vertices) << "every position is stored once";
    if (GetParam().closed) {
      EXPECT_GT(report.volume, 0);
    }
  }
}

TEST_P(ShapeTest, TrianglesHaveArea) {
  for (const std::size_t count : counts()) {
    const Mesh mesh = make(count);
    const double mean = validate(mesh, build_topology(mesh)).area / static_cast<double>(mesh.faces.size());
    EXPECT_GT(test::smallest_face_area(mesh), 0.02 * mean) << count;
  }
}

TEST_P(ShapeTest, NormalsLookTheWayTheFacesDo) {
  for (const std::size_t count : counts()) {
    const Mesh mesh = make(count);
    if (mesh.faces.size() < GetParam().exact_from) continue;
    EXPECT_GT(test::worst_normal_agreement(mesh), 0) << count;
  }
}

TEST_P(ShapeTest, MeetsTheRequestedFaceCount) {
  for (const std::size_t count : {1000u, 1024u, 5000u, 8192u, 20000u, 100000u}) {
    const auto wanted = static_cast<double>(count), made = static_cast<double>(make(count).faces.size());
    EXPECT_NEAR(made / wanted, 1.0, GetParam().nearness) << count;
  }
}

TEST_P(ShapeTest, SameBitsForAnyNumberOfThreadsAndEveryTime) {
  const auto with = [&](int threads) {
    const ThreadLimit limit(threads);
    return make(40000);
  };
  const Mesh one = with(1);
  test::expect_same_bits(one, with(2));
  test::expect_same_bits(one, make(40000));
}

TEST_P(ShapeTest, LiesAboutTheOriginNearTheUnitSphere) {
  const Mesh mesh = make(0);
  for (const Vec3& p : mesh.positions)
    ASSERT_LT(glm::length(p), 1.25f);
  const Bounds bounds = face_bounds(mesh);
  EXPECT_LT(glm::length(bounds.center()), 0.2f);
  EXPECT_GT(bounds.diagonal(), 1.5);
}

TEST_P(ShapeTest, RefusesCountsItCannotMeet) {
  const std::size_t smallest = GetParam().smallest;
  if (smallest > 1) {
    const Result<Mesh> few = make_shape(GetParam().shape, {smallest - 1, 1});
    ASSERT_FALSE(few.has_value());
    EXPECT_EQ(few.error().code, ErrorCode::kInvalidArgument);
    EXPECT_NE(few.error().message.find(std::to_string(smallest)), std::string::npos);
  }
  const Result<Mesh> many = make_shape(GetParam().shape, {(std::size_t{1} << 30) + 1, 1});
  ASSERT_FALSE(many.has_value());
  EXPECT_EQ(many.error().code, ErrorCode::kInvalidArgument);
}

std::string shape_name(const testing::TestParamInfo<Expected>& info) {
  return std::string(shapes()[static_cast<std::size_t>(info.param.shape)].name);
}

INSTANTIATE_TEST_SUITE_P(
    All, ShapeTest,
    testing::Values(Expected{Shape::kTetrahedron, 2, true, 4, 0.04, 0}, Expected{Shape::kCube, 2, true, 12, 0.06, 0},
                    Expected{Shape::kIcosphere, 2, true, 20, 0.08, 0}, Expected{Shape::kTorus, 0, true, 18, 0.02, 0},
                    Expected{Shape::kKnot, 0, true, 144, 0.02, 0}, Expected{Shape::kHoles3, -4, true, 400, 0.1, 0},
                    Expected{Shape::kAsteroid, 2, true, 20, 0.08, 20000},
                    Expected{Shape::kSheet, 1, false, 2, 0.02, 20}, Expected{Shape::kTerrain, 1, false, 2, 0.02, 500}),
    shape_name);

Mesh make(Shape shape, std::size_t faces, std::uint64_t seed = 1) {
  return make_shape(shape, {faces, seed}).value();
}

/// The mean angle, over the inner vertices, between a stored normal and the area-weighted mean of the faces around it.
/// It falls with the size of the faces only when stored normals are those of the surface.
double mean_normal_error_rad(const Mesh& mesh) {
  std::vector<DVec3> sums(mesh.positions.size(), DVec3(0.0));
  for (const Triangle& t : mesh.faces) {
    const DVec3 a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]);
    for (const VertexId v : t)
      sums[v] += glm::cross(b - a, c - a);
  }
  const Topology topology = build_topology(mesh);
  std::vector<bool> on_boundary(mesh.positions.size(), false);
  for (EdgeId e = 0; e < topology.edge_count(); ++e) {
    if (topology.edge_class[e] != EdgeClass::kBoundary) continue;
    for (const VertexId v : topology.edges[e].v)
      on_boundary[v] = true;
  }
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t v = 0; v < sums.size(); ++v) {
    if (on_boundary[v]) continue;
    const DVec3 normal(mesh.normals.values[v]);
    sum += std::atan2(glm::length(glm::cross(sums[v], normal)), glm::dot(sums[v], normal));
    ++count;
  }
  return sum / static_cast<double>(count);
}

TEST(Shapes, NormalsAreThoseOfTheSurfaceInTheLimit) {
  for (const Shape shape : {Shape::kIcosphere, Shape::kTorus, Shape::kKnot, Shape::kHoles3, Shape::kSheet}) {
    EXPECT_LT(mean_normal_error_rad(make(shape, 100000)), 0.006) << shapes()[static_cast<std::size_t>(shape)].name;
  }
  const double coarse = mean_normal_error_rad(make(Shape::kTerrain, 125000));
  const double fine = mean_normal_error_rad(make(Shape::kTerrain, 500000));
  EXPECT_LT(fine, 0.45 * coarse);
  EXPECT_LT(fine, 0.02);
}

TEST(Shapes, AsteroidNormalsStandOnItsTangents) {
  constexpr double kStep = 1e-6;
  for (std::uint64_t seed = 1; seed < 6; ++seed) {
    const procedural::AsteroidSurface surface(seed);
    Random random(seed);
    for (int i = 0; i < 400; ++i) {
      const DVec3 direction = glm::normalize(DVec3(random.direction()));
      const DVec3 normal = surface.over(direction).normal;
      for (int axis = 0; axis < 3; ++axis) {
        DVec3 step(0.0);
        step[axis] = kStep;
        const DVec3 tangent = (surface.over(glm::normalize(direction + step)).position -
                               surface.over(glm::normalize(direction - step)).position) /
                              (2 * kStep);
        ASSERT_NEAR(glm::dot(tangent, normal), 0, 1e-4);
      }
    }
  }
}

TEST(Shapes, IcospherePositionsAreTheirNormals) {
  const Mesh mesh = make(Shape::kIcosphere, 980);
  EXPECT_EQ(mesh.positions, mesh.normals.values);
  EXPECT_EQ(mesh.faces.size(), 980u);  // 20 * 7²: not only powers of two
}

TEST(Shapes, CubeHasSixFlatSidesWithHardEdges) {
  const Mesh mesh = make(Shape::kCube, 300);
  EXPECT_EQ(mesh.normals.values.size(), 6u);
  EXPECT_DOUBLE_EQ(test::worst_normal_agreement(mesh), 1.0);
  EXPECT_NEAR(test::signed_volume(mesh), 1.0, 1e-6);
}

TEST(Shapes, TorusAndHolesLieOnTheirSurfaces) {
  for (const Vec3& p : make(Shape::kTorus, 5000).positions) {
    const double out = std::hypot(p.x, p.z) - 0.7;
    ASSERT_NEAR(std::hypot(out, p.y), 0.3, 1e-6);
  }
}

/// The knot's strands keep at least this far apart, in tube radii; a smaller distance would let them touch.
TEST(Shapes, KnotStrandsAreWellApart) {
  const Mesh mesh = make(Shape::kKnot, 4000);
  double nearest = 10;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    for (std::size_t j = i + 1; j < mesh.positions.size(); ++j) {
      // Points of one strand have a part of the tube between them when their normals face one another.
      if (glm::dot(mesh.normals.values[i], mesh.normals.values[j]) > -0.9f) continue;
      const Vec3 between = mesh.positions[j] - mesh.positions[i];
      if (glm::dot(between, mesh.normals.values[i]) <= 0) continue;
      nearest = std::min(nearest, static_cast<double>(glm::length(between)));
    }
  }
  EXPECT_GT(nearest, 0.15);
}

TEST(Shapes, UvsMirrorNothing) {
  for (const ShapeInfo& info : shapes()) {
    const Mesh mesh = make_shape(info.shape).value();
    std::size_t mirrored = 0;
    for (FaceId face = 0; face < mesh.faces.size(); ++face) {
      const Vec2 a = mesh.corner(mesh.uvs, face, 0), b = mesh.corner(mesh.uvs, face, 1) - a,
                 c = mesh.corner(mesh.uvs, face, 2) - a;
      mirrored += b.x * c.y - b.y * c.x < 0;
    }
    EXPECT_EQ(mirrored, 0u) << info.name;
  }
}

TEST(Shapes, SeamsSplitTexturesNotPositions) {
  for (const Shape shape : {Shape::kIcosphere, Shape::kTorus, Shape::kKnot}) {
    const Mesh mesh = make(shape, 2000);
    EXPECT_GT(mesh.uvs.values.size(), mesh.positions.size());
    for (FaceId face = 0; face < mesh.faces.size(); ++face) {
      for (int c = 0; c < 3; ++c) {
        const Vec2 step = mesh.corner(mesh.uvs, face, (c + 1) % 3) - mesh.corner(mesh.uvs, face, c);
        ASSERT_LT(std::abs(step.x), 0.5f) << "no face runs backwards across the picture";
        ASSERT_LT(std::abs(step.y), 0.5f);
      }
    }
  }
}

TEST(Shapes, SeedsChangeAsteroidsAndTerrains) {
  for (const Shape shape : {Shape::kAsteroid, Shape::kTerrain}) {
    EXPECT_NE(make(shape, 500, 1).positions, make(shape, 500, 2).positions);
  }
}

TEST(Shapes, AsteroidStaysOutsideItsMiddleForManySeeds) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    for (const Vec3& p : make(Shape::kAsteroid, 2000, seed).positions) {
      ASSERT_GT(glm::length(p), 0.2f) << seed;
      ASSERT_LT(glm::length(p), 1.4f) << seed;
    }
  }
}

TEST(Shapes, NamesAreThoseOfTheEnumeration) {
  ASSERT_EQ(shapes().size(), 9u);
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < shapes().size(); ++i) {
    EXPECT_EQ(static_cast<std::size_t>(shapes()[i].shape), i);
    names.insert(shapes()[i].name);
  }
  EXPECT_EQ(names.size(), 9u);
}

TEST(ShapesNoise, GradientsEqualDifferenceQuotients) {
  constexpr double kStep = 1e-6;
  const procedural::OctaveOptions options{4, 1.3, 0.7, 2.03, 0.5};
  Random random(5);
  for (int i = 0; i < 300; ++i) {
    const DVec3 p(random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 9));
    for (const auto field : {procedural::octave_noise, procedural::ridged_noise}) {
      const procedural::FieldSample here = field(p, 3, options);
      for (int axis = 0; axis < 3; ++axis) {
        DVec3 step(0.0);
        step[axis] = kStep;
        const double slope = (field(p + step, 3, options).value - field(p - step, 3, options).value) / (2 * kStep);
        ASSERT_NEAR(here.gradient[axis], slope, 2e-5);
      }
    }
  }
}

}  // namespace
}  // namespace limn
