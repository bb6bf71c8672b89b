#include "reduce.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <set>
#include <tuple>

#include "limn/mesh/normals.h"
#include "limn/mesh/shapes.h"
#include "limn/mesh/topology.h"

namespace limn::bench {
namespace {

using Point = std::tuple<float, float, float>;

Point point(const Vec3& p) {
  return {p.x, p.y, p.z};
}

// A box of n × n quads a side, vertices shared: its hard edges are known from the geometry alone.
Mesh fine_box(int n) {
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool far : {false, true}) {
      const auto vertex = [&](int i, int j) {
        Vec3 p(0);
        p[axis] = far ? static_cast<float>(n) : 0.0f;
        p[(axis + 1) % 3] = static_cast<float>(i);
        p[(axis + 2) % 3] = static_cast<float>(j);
        mesh.positions.push_back(p);
        return static_cast<VertexId>(mesh.positions.size() - 1);
      };
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
          const VertexId a = vertex(i, j), b = vertex(i + 1, j), c = vertex(i + 1, j + 1), d = vertex(i, j + 1);
          mesh.faces.push_back(far ? Triangle{a, b, c} : Triangle{a, c, b});
          mesh.faces.push_back(far ? Triangle{a, c, d} : Triangle{a, d, c});
        }
      }
    }
  }
  return mesh;
}

TEST(Reduce, MeetsTheNumberOfFacesAcrossATextureSeamAndStaysClosed) {
  const Result<Mesh> knot = make_shape(Shape::kKnot, {.faces = 20'000});
  ASSERT_TRUE(knot);
  const Mesh reduced = reduce(*knot, 1000, 3.15f);
  EXPECT_LE(reduced.face_count(), 1000u);
  EXPECT_GE(reduced.face_count(), 990u);
  const Topology topology = build_topology(reduced);
  EXPECT_TRUE(topology.degenerate_faces.empty());
  EXPECT_TRUE(std::all_of(topology.edge_class.begin(), topology.edge_class.end(),
                          [](EdgeClass c) { return c == EdgeClass::kManifold; }));
}

TEST(Reduce, KeepsPositionsAndNormalsOfTheOriginal) {
  const Result<Mesh> knot = make_shape(Shape::kKnot, {.faces = 20'000});
  ASSERT_TRUE(knot);
  std::set<std::pair<Point, Point>> originals;
  for (FaceId f = 0; f < knot->face_count(); ++f) {
    for (int c = 0; c < 3; ++c) {
      originals.insert({point(knot->positions[knot->faces[f][c]]), point(knot->corner(knot->normals, f, c))});
    }
  }
  const Mesh reduced = reduce(*knot, 1000, 3.15f);
  for (FaceId f = 0; f < reduced.face_count(); ++f) {
    for (int c = 0; c < 3; ++c) {
      const auto corner =
          std::pair{point(reduced.positions[reduced.faces[f][c]]), point(reduced.corner(reduced.normals, f, c))};
      ASSERT_TRUE(originals.contains(corner)) << "face " << f << ", corner " << c;
    }
  }
}

TEST(Reduce, GivesCornersAtACreaseTheNormalOfTheirOwnSide) {
  const Mesh box = fine_box(12);
  const Mesh reduced = reduce(box, 60, 0.5f);
  EXPECT_LE(reduced.face_count(), 60u);
  const std::vector<Vec3> faces = face_normals(reduced);
  std::size_t with_area = 0;
  for (FaceId f = 0; f < reduced.face_count(); ++f) {
    if (faces[f] == Vec3(0)) continue;  // three corners on one edge of the box have no side
    ++with_area;
    for (int c = 0; c < 3; ++c) {
      const Vec3 normal = reduced.corner(reduced.normals, f, c);
      ASSERT_NEAR(normal.x * faces[f].x + normal.y * faces[f].y + normal.z * faces[f].z, 1.0, 1e-6) << "face " << f;
    }
  }
  EXPECT_GE(with_area, 12u);
}

TEST(Reduce, UsesEveryVertexItKeeps) {
  const Mesh reduced = reduce(fine_box(8), 100, 0.5f);
  std::set<VertexId> used;
  for (const Triangle& face : reduced.faces)
    used.insert(face.begin(), face.end());
  EXPECT_EQ(used.size(), reduced.positions.size());
}

}  // namespace
}  // namespace limn::bench
