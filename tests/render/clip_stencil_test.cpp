// What the stencil counts: loops and their triangles, and which faces may turn over.
#include <algorithm>
#include <cmath>
#include <map>

#include "limn/base/random.h"
#include "limn/render/camera_block.h"
#include "limn/render/clip/edge_on.h"
#include "limn/render/clip/stencil_loops.h"
#include "limn/silhouette/brute.h"

#include "clip_bodies.h"

namespace limn {
namespace {

/// Twice the area that the triangles' directions add up to, of points seen along z.
double signed_area(const StencilLoops& loops) {
  double sum = 0;
  for (std::size_t i = 0; i + 2 < loops.corners.size(); i += 3) {
    const DVec3 a = loops.points[loops.corners[i]], b = loops.points[loops.corners[i + 1]],
                c = loops.points[loops.corners[i + 2]];
    sum += (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  }
  return sum;
}

/// Directed edges of the triangles, those that run both ways taken out.
std::map<std::pair<std::uint32_t, std::uint32_t>, int> open_edges(const LineVector<std::uint32_t>& corners) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const std::uint32_t from = corners[i], to = corners[i % 3 == 2 ? i - 2 : i + 1];
    if (--edges[{to, from}] == 0) edges.erase({to, from});
    if (++edges[{from, to}] == 0) edges.erase({from, to});
  }
  for (auto it = edges.begin(); it != edges.end();)
    it = it->second <= 0 ? edges.erase(it) : std::next(it);
  return edges;
}

TEST(StencilLoops, ALoopOfAnyLengthIsFilledByTwoTrianglesLessThanItsEdges) {
  for (std::uint32_t count = 3; count < 400; ++count) {
    LineVector<std::uint32_t> corners;
    append_loop_triangles(5, count, corners);
    ASSERT_EQ(corners.size(), 3 * (count - 2)) << count;
    const auto edges = open_edges(corners);
    ASSERT_EQ(edges.size(), count);
    for (std::uint32_t i = 0; i < count; ++i)
      ASSERT_TRUE(edges.contains({5 + i, 5 + (i + 1) % count})) << count << ", edge " << i;
  }
}

TEST(StencilLoops, TwoEdgesThereAndBackNeedNoTriangle) {
  LineVector<std::uint32_t> corners;
  append_loop_triangles(0, 2, corners);
  EXPECT_TRUE(corners.empty());
}

/// Area of the front faces seen along z, twice.
double front_area(const Mesh& mesh, std::span<const Plane> planes, const Eye& eye) {
  double sum = 0;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    if (!faces_eye(planes[f], eye)) continue;
    const DVec3 a = mesh.positions[mesh.faces[f][0]], b = mesh.positions[mesh.faces[f][1]],
                c = mesh.positions[mesh.faces[f][2]];
    sum += (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  }
  return sum;
}

TEST(StencilLoops, EveryDecompositionCoversWhatTheFrontFacesCover) {
  for (const Shape kind : {Shape::kKnot, Shape::kHoles3, Shape::kAsteroid, Shape::kCube}) {
    const Mesh mesh = test::shape(kind, kind == Shape::kCube ? 12 : 3000);
    const Topology topology = build_topology(mesh);
    const std::vector<Plane> planes = face_planes(mesh);
    const Eye eye{Vec3(0, 0, 1), true};
    std::vector<EdgeId> edges;
    extract_silhouette_brute(topology, planes, eye, edges);
    Mesh welded = mesh;
    StencilLoopBuilder builder(welded, topology, planes);
    StencilLoops loops, again;
    builder.build(edges, eye, loops);
    EXPECT_EQ(loops.edge_count, edges.size());
    EXPECT_LE(loops.triangle_count(), edges.size());
    EXPECT_NEAR(signed_area(loops), front_area(mesh, planes, eye), 1e-5);
    builder.build(edges, eye, again);
    EXPECT_TRUE(std::equal(loops.corners.begin(), loops.corners.end(), again.corners.begin(), again.corners.end()));
  }
}

/// Two tetrahedra that share an edge: four faces at it.
Mesh hinged_tetrahedra() {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0.5f, 1, 0}, {-1, 0, 0.2f}, {-0.5f, -1, 0}};
  mesh.faces = {{0, 2, 3}, {0, 3, 1}, {0, 1, 2}, {1, 3, 2}, {0, 4, 5}, {0, 5, 1}, {0, 1, 4}, {1, 5, 4}};
  return mesh;
}

TEST(StencilLoops, EdgesOfFourFacesCloseTheLoopsToo) {
  const Mesh mesh = hinged_tetrahedra();
  const Topology topology = build_topology(mesh);
  ASSERT_EQ(topology.non_manifold_edges.size(), 1u);
  ASSERT_TRUE(is_closed(topology));
  const std::vector<Plane> planes = face_planes(mesh);
  StencilLoopBuilder builder(mesh, topology, planes);
  Random random(3);
  for (int view = 0; view < 50; ++view) {
    const Eye eye{
        Vec3(static_cast<float>(random.uniform(-0.4, 0.4)), static_cast<float>(random.uniform(-0.4, 0.4)), 1.0f), true};
    std::vector<EdgeId> edges;
    extract_silhouette_brute(topology, planes, eye, edges);
    StencilLoops loops;
    builder.build(edges, eye, loops);
    std::map<std::pair<float, float>, int> balance;  // of edges that leave and reach each point
    for (const auto& [edge, times] : open_edges(loops.corners)) {
      balance[{loops.points[edge.first].x, loops.points[edge.first].z}] += times;
      balance[{loops.points[edge.second].x, loops.points[edge.second].z}] -= times;
    }
    for (const auto& [point, sum] : balance)
      EXPECT_EQ(sum, 0);
  }
}

TEST(StencilLoops, OpenMeshesAreNotClosed) {
  EXPECT_FALSE(is_closed(build_topology(test::shape(Shape::kSheet, 200))));
  Mesh open = test::shape(Shape::kKnot, 1000);
  open.faces.pop_back();
  EXPECT_FALSE(is_closed(build_topology(open)));
}

/// Faces whose corners, moved to any grid points around them, may change the turn of the triangle: the slow way.
std::size_t count_missed(const Mesh& mesh, const Camera& camera, int size_px, std::size_t& found,
                         std::size_t& flipped) {
  const CameraBlock block = make_camera_block(camera, size_px, size_px);
  const std::vector<Plane> planes = face_planes(mesh);
  const EdgeOnFaces faces(mesh, leaf_clusters(mesh, build_topology(mesh), planes), planes);
  PictureScale scale;
  scale.eye = eye_of(camera);
  const glm::dmat3 axes = glm::transpose(glm::dmat3(block.rotation));
  scale.right = Vec3(axes[0]), scale.up = Vec3(axes[1]), scale.forward = Vec3(-axes[2]);
  scale.origin = camera.eye;
  scale.pixels_per_unit = 1.0f / block.pixel_size;
  scale.widest_cosine = 0.7f;
  LineVector<Vec3> points;
  faces.find(scale, points);
  found += points.size() / 3;
  std::size_t missed = 0;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    glm::dvec2 p[3];
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec4 clip = block.projection * (block.rotation * Vec4(mesh.positions[mesh.faces[f][c]] - block.eye, 1.0f));
      const Vec2 window = (Vec2(clip) / clip.w * 0.5f + 0.5f) * static_cast<float>(size_px);
      p[c] = glm::round(glm::dvec2(window) * 256.0) / 256.0;
    }
    const glm::dvec2 a = p[1] - p[0], b = p[2] - p[0];
    const double turn = a.x * b.y - a.y * b.x;
    if (turn == 0.0 || (turn > 0.0) == faces_eye(planes[f], scale.eye)) continue;
    ++flipped;
    bool in_list = false;
    for (std::size_t i = 0; i < points.size() && !in_list; i += 3)
      in_list = points[i] == mesh.positions[mesh.faces[f][0]] && points[i + 1] == mesh.positions[mesh.faces[f][1]] &&
                points[i + 2] == mesh.positions[mesh.faces[f][2]];
    missed += in_list ? 0 : 1;
  }
  return missed;
}

TEST(EdgeOnFaces, NoFaceThatTheGridTurnsOverIsMissed) {
  std::size_t found = 0, flipped = 0, faces = 0;
  Random random(11);
  for (const Shape kind : {Shape::kKnot, Shape::kHoles3, Shape::kAsteroid}) {
    const Mesh mesh = test::shape(kind, 20000);
    for (int view = 0; view < 6; ++view) {
      CameraFit fit;
      fit.orthographic = view % 3 == 2;
      fit.fov_rad = view % 3 == 1 ? 1.3f : 0.6f;
      fit.fill = view < 3 ? 0.9f : 0.25f;
      EXPECT_EQ(count_missed(mesh, fit_camera(face_bounds(mesh), random.direction(), fit), 256, found, flipped), 0u);
      faces += mesh.face_count();
    }
  }
  EXPECT_GT(flipped, 50u);
  EXPECT_LT(found, faces / 20) << "nearly all others keep their side";
}

}  // namespace
}  // namespace limn
