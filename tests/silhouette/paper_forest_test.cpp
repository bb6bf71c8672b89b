#include "limn/silhouette/sander/paper_forest.h"

#include <algorithm>
#include <cstring>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <limits>

#include "limn/base/bounds.h"
#include "limn/base/parallel.h"
#include "limn/base/random.h"
#include "limn/mesh/normals.h"
#include "limn/mesh/shapes.h"
#include "limn/silhouette/brute.h"
#include "limn/silhouette/sander/johannsen_carter.h"

#include "support/stable.h"

namespace limn {
namespace {

/// A mesh with all that a search needs.
struct Searched {
  explicit Searched(const Mesh& m, const PaperForestOptions& options = {})
      : mesh(m), topology(build_topology(m)), planes(face_planes(m)) {
    forest = *build_paper_forest(mesh, topology, planes, options);
    bounds = johannsen_carter_bounds(forest, mesh, topology);
  }
  std::vector<EdgeId> brute(const Eye& eye) const {
    std::vector<EdgeId> edges;
    extract_silhouette_brute(topology, planes, eye, edges);
    return edges;
  }
  std::vector<EdgeId> search(const Eye& eye, SearchCounts* counts = nullptr) const {
    std::vector<EdgeId> edges;
    const SearchCounts found = extract_silhouette_forest(forest, eye, edges);
    if (counts != nullptr) *counts = found;
    std::sort(edges.begin(), edges.end());
    return edges;
  }
  std::vector<EdgeId> search_johannsen_carter(const Eye& eye, SearchCounts* counts = nullptr) const {
    std::vector<EdgeId> edges;
    const SearchCounts found = extract_silhouette_johannsen_carter(forest, bounds, eye, edges);
    if (counts != nullptr) *counts = found;
    std::sort(edges.begin(), edges.end());
    return edges;
  }

  Mesh mesh;
  Topology topology;
  std::vector<Plane> planes;
  PaperForest forest;
  std::vector<JohannsenCarterBound> bounds;
};

Vec3 in_plane_of_a_face(Random& random, const Mesh& mesh) {
  const Triangle& face = mesh.faces[random.below(mesh.faces.size())];
  const DVec3 a = mesh.positions[face[0]];
  const double u = random.uniform(-3, 3);
  const double v = random.uniform(-3, 3);
  return Vec3(a + u * (DVec3(mesh.positions[face[1]]) - a) + v * (DVec3(mesh.positions[face[2]]) - a));
}

/// On planes, inside, at three radii, far away, at infinity, and where floats end.
Eye random_eye(Random& random, const Mesh& mesh) {
  const Bounds bounds = bounds_of(mesh.positions);
  const DVec3 center(bounds.empty() ? Vec3(0) : bounds.center());
  const double size = std::max(bounds.diagonal(), 1e-30) / 2;
  const double radii[] = {0.1, 0.7, 1.2, 3, 10, 1e3, 1e6};
  switch (random.below(8)) {
    case 0:
      return {random.direction(), true};
    case 1:
      return {random.direction() * 1e-6f, true};
    case 2:
      if (!mesh.positions.empty()) return {mesh.positions[random.below(mesh.positions.size())], false};
      [[fallthrough]];
    case 3:
      if (!mesh.faces.empty()) return {in_plane_of_a_face(random, mesh), random.below(4) == 0};
      [[fallthrough]];
    default:
      return {Vec3(center + DVec3(random.direction()) * (size * radii[random.below(7)])), false};
  }
}

TEST(PaperForest, EqualsBruteForceOnAwkwardMeshesFromManyEyes) {
  Random random(21);
  std::size_t found = 0;
  for (const test::StableMesh& item : test::awkward_meshes()) {
    const Searched searched(item.mesh);
    for (int view = 0; view < 200; ++view) {
      const Eye eye = random_eye(random, item.mesh);
      const std::vector<EdgeId> expected = searched.brute(eye);
      ASSERT_EQ(searched.search(eye), expected) << item.name << " view " << view;
      ASSERT_EQ(searched.search_johannsen_carter(eye), expected) << item.name << " view " << view;
      found += expected.size();
    }
  }
  EXPECT_GT(found, 10000u);
}

TEST(PaperForest, EqualsBruteForceOnShapesAndTestsFewEdges) {
  Random random(22);
  for (const Shape shape : {Shape::kAsteroid, Shape::kKnot, Shape::kHoles3, Shape::kIcosphere, Shape::kTerrain}) {
    const Searched searched(*make_shape(shape, {.faces = 4000}));
    SearchCounts total, johannsen_carter;
    for (int view = 0; view < 100; ++view) {
      const Eye eye = random_eye(random, searched.mesh);
      SearchCounts counts, other;
      const std::vector<EdgeId> expected = searched.brute(eye);
      ASSERT_EQ(searched.search(eye, &counts), expected);
      ASSERT_EQ(searched.search_johannsen_carter(eye, &other), expected);
      total.edges += counts.edges;
      total.nodes += counts.nodes;
      johannsen_carter.edges += other.edges;
      johannsen_carter.nodes += other.nodes;
    }
    const double all = 100.0 * static_cast<double>(searched.topology.edge_count());
    EXPECT_LT(total.edge_equivalents(), 0.8 * all) << static_cast<int>(shape);
    // The paper's finding: anchored cones cull more than half-spaces do.
    EXPECT_LT(total.edge_equivalents(), johannsen_carter.edge_equivalents()) << static_cast<int>(shape);
  }
}

TEST(PaperForest, HoldsEachEdgeWithTwoFacesOnceAndItsNodesNest) {
  for (const test::StableMesh& item : test::awkward_meshes()) {
    const Searched searched(item.mesh);
    std::vector<EdgeId> held;
    for (const PaperForestEdge& edge : searched.forest.edges)
      held.push_back(edge.edge);
    std::sort(held.begin(), held.end());
    std::vector<EdgeId> expected;
    for (EdgeId e = 0; e < searched.topology.edge_count(); ++e) {
      const EdgeClass edge_class = searched.topology.edge_class[e];
      if (edge_class == EdgeClass::kManifold || edge_class == EdgeClass::kInconsistent) expected.push_back(e);
    }
    EXPECT_EQ(held, expected) << item.name;
    std::uint32_t at = 0;
    std::size_t roots = 0;
    std::uint32_t next_root = 0;
    for (std::uint32_t i = 0; i < searched.forest.nodes.size(); ++i) {
      const PaperForestNode& node = searched.forest.nodes[i];
      EXPECT_EQ(node.edge_begin, at) << item.name;
      EXPECT_GT(node.skip, i) << item.name;
      at = node.edge_end;
      if (i == next_root) {
        ++roots;
        next_root = node.skip;
      }
    }
    EXPECT_EQ(at, searched.forest.edges.size()) << item.name;
    EXPECT_EQ(roots, searched.forest.root_count) << item.name;
  }
}

TEST(PaperForest, FacesWithoutAreaAreNeverCulled) {
  // A sphere one of whose edges carries a face without area: from the front that face is still "back".
  Mesh mesh = *make_shape(Shape::kIcosphere, {.faces = 320});
  const Triangle split = mesh.faces[17];
  const Vec3 a = mesh.positions[split[0]];
  const Vec3 b = mesh.positions[split[1]];
  mesh.positions.push_back(a + 0.5f * (b - a));
  const auto middle = static_cast<VertexId>(mesh.positions.size() - 1);
  mesh.faces[17] = {split[0], middle, split[2]};
  mesh.faces.push_back({middle, split[1], split[2]});
  mesh.faces.push_back({split[0], split[1], middle});
  std::vector<Plane> planes = face_planes(mesh);
  // The middle rounds: the face has next to no area, and now none.
  planes.back() = {0, 0, 0, 0};
  const Topology topology = build_topology(mesh);
  const PaperForest forest = *build_paper_forest(mesh, topology, planes);
  Random random(23);
  std::size_t with_flat_face = 0;
  for (int view = 0; view < 200; ++view) {
    const Eye eye{random.direction() * 5.0f, view % 2 == 0};
    std::vector<EdgeId> expected, found;
    extract_silhouette_brute(topology, planes, eye, expected);
    extract_silhouette_forest(forest, eye, found);
    std::sort(found.begin(), found.end());
    ASSERT_EQ(found, expected);
    for (const EdgeId e : expected)
      with_flat_face +=
          topology.edges[e].face[1] == mesh.faces.size() - 1 || topology.edges[e].face[0] == mesh.faces.size() - 1;
  }
  EXPECT_GT(with_flat_face, 0u);
}

TEST(PaperForest, AnEyeWhereFloatsEndIsSearchedWithoutCulling) {
  const Searched searched(*make_shape(Shape::kIcosphere, {.faces = 320}));
  const float big = std::numeric_limits<float>::max();
  const float infinity = std::numeric_limits<float>::infinity();
  for (const Vec3& at : {Vec3(big, -big, big), Vec3(big, 0, 0), Vec3(1e38f, 1e38f, -1e38f), Vec3(infinity, 0, 0),
                         Vec3(std::nanf(""), 0, 0), Vec3(1e-42f, -2e-42f, 1e-43f)}) {
    for (const bool orthographic : {false, true}) {
      const Eye eye{at, orthographic};
      EXPECT_EQ(searched.search(eye), searched.brute(eye));
      EXPECT_EQ(searched.search_johannsen_carter(eye), searched.brute(eye));
    }
  }
}

bool same_forest(const PaperForest& a, const PaperForest& b) {
  return a.nodes.size() == b.nodes.size() && a.edges.size() == b.edges.size() &&
         std::memcmp(a.nodes.data(), b.nodes.data(), a.nodes.size() * sizeof(PaperForestNode)) == 0 &&
         std::memcmp(a.edges.data(), b.edges.data(), a.edges.size() * sizeof(PaperForestEdge)) == 0;
}

TEST(PaperForest, IsTheSameForAnyNumberOfThreads) {
  const Mesh mesh = *make_shape(Shape::kAsteroid, {.faces = 3000});
  const Searched several(mesh);
  const ThreadLimit limit(1);
  EXPECT_TRUE(same_forest(several.forest, Searched(mesh).forest));
}

TEST(PaperForest, OfFewerEdgesThanTwoIsARootEach) {
  Mesh tent;
  tent.positions = {{0, 0, 0}, {1, 0, 0}, {0.5f, -1, 0}, {0.5f, 0, -1}};
  tent.faces = {{0, 2, 1}, {0, 1, 3}};
  const Searched searched(tent);
  ASSERT_EQ(searched.forest.nodes.size(), 1u);
  EXPECT_EQ(searched.forest.edges.size(), 1u);
  // The four quarters of space about the tent's ridge.
  SearchCounts counts;
  searched.search({Vec3(0.5f, 3, 3), false}, &counts);
  EXPECT_EQ(counts.edges, 0u);
  searched.search({Vec3(0.5f, -3, -3), false}, &counts);
  EXPECT_EQ(counts.edges, 0u);
  searched.search({Vec3(0.5f, -3, 3), false}, &counts);
  EXPECT_EQ(counts.edges, 1u);
  const Searched none((Mesh()));
  EXPECT_TRUE(none.forest.nodes.empty());
}

TEST(PaperForest, SimilarNormalsAndOtherOptionsChangeTheForestNotTheResult) {
  const Mesh mesh = *make_shape(Shape::kHoles3, {.faces = 2000});
  const Searched plain(mesh);
  Random random(24);
  for (const PaperForestOptions& options :
       {PaperForestOptions{.similar_normals_rad = 0.1}, PaperForestOptions{.cone_cost = 4},
        PaperForestOptions{.viewpoint_radius = std::numeric_limits<double>::infinity()}}) {
    const Searched other(mesh, options);
    EXPECT_FALSE(same_forest(plain.forest, other.forest));
    for (int view = 0; view < 50; ++view) {
      const Eye eye = random_eye(random, mesh);
      ASSERT_EQ(other.search(eye), plain.brute(eye));
    }
  }
}

TEST(PaperForest, RefusesOptionsOutOfRangeAndCanBeCancelled) {
  const Mesh mesh = *make_shape(Shape::kIcosphere, {.faces = 320});
  const Topology topology = build_topology(mesh);
  const std::vector<Plane> planes = face_planes(mesh);
  for (const PaperForestOptions& options :
       {PaperForestOptions{.cone_cost = 0}, PaperForestOptions{.viewpoint_radius = 0.5},
        PaperForestOptions{.similar_normals_rad = -1}, PaperForestOptions{.viewpoint_radius = std::nan("")}}) {
    const Result<PaperForest> forest = build_paper_forest(mesh, topology, planes, options);
    ASSERT_FALSE(forest);
    EXPECT_EQ(forest.error().code, ErrorCode::kInvalidArgument);
  }
  const auto stop = [](std::string_view, double) { return false; };
  const Result<PaperForest> cancelled = build_paper_forest(mesh, topology, planes, {}, stop);
  ASSERT_FALSE(cancelled);
  EXPECT_EQ(cancelled.error().code, ErrorCode::kCancelled);
}

}  // namespace
}  // namespace limn
