#include "limn/silhouette/contours.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <map>
#include <set>

#include "limn/base/random.h"
#include "limn/mesh/normals.h"
#include "limn/mesh/shapes.h"
#include "limn/silhouette/brute.h"
#include "limn/silhouette/classes.h"

#include "support/stable.h"

namespace limn {
namespace {

struct Seen {
  Mesh mesh;
  Topology topology;
  std::vector<Plane> planes;

  explicit Seen(Mesh m) : mesh(std::move(m)), topology(build_topology(mesh)), planes(face_planes(mesh)) {}

  std::vector<EdgeId> silhouette(const Eye& eye) const {
    std::vector<EdgeId> edges;
    extract_silhouette_brute(topology, planes, eye, edges);
    return edges;
  }
  Chains contours(const Eye& eye) const { return chain_silhouette(topology, planes, eye, silhouette(eye)); }
};

/// Near, far, at infinity, inside, and on vertices and hence on planes.
Eye random_eye(Random& random, const Mesh& mesh) {
  const Bounds bounds = face_bounds(mesh);
  if (random.below(4) == 0 || bounds.empty()) return {random.direction(), true};
  if (random.below(8) == 0) return {mesh.positions[random.below(mesh.positions.size())], false};
  const double radii[] = {0.3, 2.0, 50.0};
  const double size = std::max(bounds.diagonal(), 1e-30) * radii[random.below(3)];
  return {Vec3(DVec3(bounds.center()) + DVec3(random.direction()) * size), false};
}

bool has_inconsistent_edges(const Topology& topology) {
  return std::count(topology.edge_class.begin(), topology.edge_class.end(), EdgeClass::kInconsistent) > 0;
}

/// Every step runs along its edge, steps follow each other, `closed` is true, and the edges are exactly `expected`.
void expect_chains_of(const Chains& chains, const Topology& topology, std::vector<EdgeId> expected,
                      const std::string& name) {
  std::vector<EdgeId> edges;
  std::uint32_t next = 0;
  for (const Chain& chain : chains.chains) {
    ASSERT_EQ(chain.begin, next) << name;
    ASSERT_LT(chain.begin, chain.end) << name;
    next = chain.end;
    for (std::uint32_t i = chain.begin; i < chain.end; ++i) {
      const ChainStep& step = chains.steps[i];
      const Edge& edge = topology.edges[step.edge];
      EXPECT_EQ(std::minmax(step.from, step.to), std::minmax(edge.v[0], edge.v[1])) << name;
      if (i + 1 < chain.end) {
        EXPECT_EQ(step.to, chains.steps[i + 1].from) << name;
      }
      edges.push_back(step.edge);
    }
    if (chain.closed) {
      EXPECT_EQ(chains.steps[chain.end - 1].to, chains.steps[chain.begin].from) << name;
    }
  }
  ASSERT_EQ(next, chains.steps.size()) << name;
  std::sort(edges.begin(), edges.end());
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(edges, expected) << name;
}

TEST(Contours, AreClosedOnClosedMeshesAndCoverTheSilhouetteOnceFromManyEyes) {
  Random random(31);
  std::size_t loops = 0;
  for (test::StableMesh& item : test::awkward_meshes()) {
    const Seen seen(std::move(item.mesh));
    for (int view = 0; view < 40; ++view) {
      const Eye eye = random_eye(random, seen.mesh);
      const std::vector<EdgeId> edges = seen.silhouette(eye);
      const Chains chains = chain_silhouette(seen.topology, seen.planes, eye, edges);
      ASSERT_NO_FATAL_FAILURE(expect_chains_of(chains, seen.topology, edges, item.name));
      if (!item.closed || has_inconsistent_edges(seen.topology)) continue;
      for (const Chain& chain : chains.chains)
        EXPECT_TRUE(chain.closed) << item.name;
      loops += chains.chains.size();
    }
  }
  EXPECT_GT(loops, 1000u);
}

TEST(Contours, KeepTheFaceSeenFromTheFrontOnTheirLeft) {
  Random random(32);
  for (test::StableMesh& item : test::awkward_meshes()) {
    const Seen seen(std::move(item.mesh));
    for (int view = 0; view < 10; ++view) {
      const Eye eye = random_eye(random, seen.mesh);
      for (const ChainStep& step : seen.contours(eye).steps) {
        const Edge& edge = seen.topology.edges[step.edge];
        const FaceId front = faces_eye(seen.planes[edge.face[0]], eye) ? edge.face[0] : edge.face[1];
        const Triangle& t = seen.topology.faces[front];
        const auto at = static_cast<std::size_t>(std::find(t.begin(), t.end(), step.from) - t.begin());
        ASSERT_LT(at, 3u) << item.name;
        EXPECT_EQ(t[(at + 1) % 3], step.to) << item.name;
      }
    }
  }
}

TEST(Contours, DoNotDependOnTheOrderOfTheEdgesNorOnRepeats) {
  const Seen seen(*make_shape(Shape::kAsteroid, {.faces = 5000}));
  const Eye eye{Vec3(2, 1, 3), false};
  std::vector<EdgeId> edges = seen.silhouette(eye);
  const Chains once = chain_silhouette(seen.topology, seen.planes, eye, edges);
  edges.push_back(edges[5]);
  std::reverse(edges.begin(), edges.end());
  const Chains again = chain_silhouette(seen.topology, seen.planes, eye, edges);
  ASSERT_EQ(once.steps.size(), again.steps.size());
  for (std::size_t i = 0; i < once.steps.size(); ++i) {
    EXPECT_EQ(once.steps[i].edge, again.steps[i].edge);
    EXPECT_EQ(once.steps[i].from, again.steps[i].from);
  }
  ASSERT_EQ(once.chains.size(), again.chains.size());
}

TEST(Contours, OfAConvexSphereAreOneLoop) {
  const Seen seen(*make_shape(Shape::kIcosphere, {.faces = 5120}));
  Random random(33);
  for (int view = 0; view < 20; ++view) {
    const Chains chains = seen.contours({random.direction() * 3.0f, false});
    ASSERT_EQ(chains.chains.size(), 1u);
    EXPECT_TRUE(chains.chains[0].closed);
  }
}

TEST(Contours, ThatMeetAtAVertexStayWithTheFacesOnTheirLeft) {
  // Two pyramids, base down, that share their apex only: from above the apex both contours may pass through it.
  Mesh mesh;
  mesh.positions = {{0, 0, 0},      {1, -1, 0.2f}, {1, 1, 0.2f},  {2, 0, -0.5f},
                    {-1, -1, 0.2f}, {-1, 1, 0.2f}, {-2, 0, -0.5f}};
  mesh.faces = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}, {0, 5, 4}, {0, 4, 6}, {0, 6, 5}, {4, 5, 6}};
  const Seen seen(std::move(mesh));
  const Chains chains = seen.contours({Vec3(0, 0, 1), true});
  ASSERT_EQ(chains.chains.size(), 2u);
  for (const Chain& chain : chains.chains) {
    std::set<bool> right;
    for (std::uint32_t i = chain.begin; i < chain.end; ++i) {
      if (chains.steps[i].from != 0) right.insert(chains.steps[i].from <= 3);
    }
    EXPECT_EQ(right.size(), 1u);
  }
}

TEST(Contours, OfASheetEndWhereTheSheetEnds) {
  // A gable: its ridge is a contour from the side, open at both ends.
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 1}, {1, 1, 1}, {0, 0, 2}, {1, 0, 2}};
  mesh.faces = {{0, 3, 1}, {0, 2, 3}, {2, 5, 3}, {2, 4, 5}};
  const Seen seen(std::move(mesh));
  const Chains chains = seen.contours({Vec3(0, 0, -1), true});
  ASSERT_EQ(chains.chains.size(), 1u);
  EXPECT_FALSE(chains.chains[0].closed);
  EXPECT_EQ(chains.steps.size(), 1u);
}

TEST(Chains, OfTheBoundaryOfASheetAreOneLoop) {
  const Seen seen(*make_shape(Shape::kSheet, {.faces = 200}));
  const std::vector<EdgeId> edges = boundary_edges(seen.topology);
  const Chains chains = chain_edges(seen.mesh, seen.topology, edges);
  expect_chains_of(chains, seen.topology, edges, "sheet");
  ASSERT_EQ(chains.chains.size(), 1u);
  EXPECT_TRUE(chains.chains[0].closed);
}

TEST(Chains, OfACubesCreasesAreItsTwelveEdges) {
  const Seen seen(*make_shape(Shape::kCube, {.faces = 192}));
  const std::vector<EdgeId> edges = crease_edges(seen.topology, face_normals(seen.mesh), 0.5f);
  const Chains chains = chain_edges(seen.mesh, seen.topology, edges);
  expect_chains_of(chains, seen.topology, edges, "cube");
  EXPECT_EQ(chains.chains.size(), 12u);
  for (const Chain& chain : chains.chains)
    EXPECT_FALSE(chain.closed);
}

TEST(Chains, CoverEveryClassOfAwkwardMeshesOnce) {
  for (test::StableMesh& item : test::awkward_meshes()) {
    const Seen seen(std::move(item.mesh));
    const std::vector<EdgeId> classes[] = {boundary_edges(seen.topology), non_manifold_edges(seen.topology),
                                           crease_edges(seen.topology, face_normals(seen.mesh), 0.1f)};
    for (const std::vector<EdgeId>& edges : classes)
      expect_chains_of(chain_edges(seen.mesh, seen.topology, edges), seen.topology, edges, item.name);
  }
}

TEST(Chains, BecomePolylinesThatNameTheirEdges) {
  const Seen seen(*make_shape(Shape::kTorus, {.faces = 800}));
  const Chains chains = seen.contours({Vec3(3, 2, 1), false});
  Polylines polylines;
  append_chains(seen.mesh, chains, LineClass::kSilhouette, polylines);
  ASSERT_EQ(polylines.lines.size(), chains.chains.size());
  ASSERT_EQ(polylines.points.size(), polylines.edges.size());
  for (const Polyline& line : polylines.lines) {
    for (std::uint32_t i = line.begin; i < line.end; ++i) {
      const std::uint32_t next = i + 1 < line.end ? i + 1 : line.begin;
      if (polylines.edges[i] == kInvalidId) continue;
      const Edge& edge = seen.topology.edges[polylines.edges[i]];
      const Vec3 a = seen.mesh.positions[edge.v[0]], b = seen.mesh.positions[edge.v[1]];
      EXPECT_TRUE((polylines.points[i] == a && polylines.points[next] == b) ||
                  (polylines.points[i] == b && polylines.points[next] == a));
    }
  }
}

TEST(Chains, TakenEdgesAreLeftOut) {
  const std::vector<EdgeId> edges = {7, 3, 5, 3}, taken = {5, 1};
  EXPECT_EQ(without_edges(edges, taken), (std::vector<EdgeId>{3, 7}));
}

}  // namespace
}  // namespace limn
