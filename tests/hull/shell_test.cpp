#include "limn/hull/shell.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <map>
#include <set>

#include "limn/base/parallel.h"
#include "limn/base/random.h"
#include "limn/hull/fill_loop.h"
#include "limn/mesh/shapes.h"

#include "support/solid.h"
#include "support/stable.h"

namespace limn::test {
namespace {

Mesh stable_mesh(std::string_view name) {
  for (StableMesh& entry : awkward_meshes()) {
    if (entry.name == name) return std::move(entry.mesh);
  }
  ADD_FAILURE() << name;
  return {};
}

/// At every edge, by position, as many sides run one way as the other.
bool is_balanced(const Mesh& mesh) {
  std::map<std::array<float, 6>, int> sides;
  for (const Triangle& t : mesh.faces) {
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3 a = mesh.positions[t[c]] + 0.0f, b = mesh.positions[t[(c + 1) % 3]] + 0.0f;
      ++sides[{a.x, a.y, a.z, b.x, b.y, b.z}];
      --sides[{b.x, b.y, b.z, a.x, a.y, a.z}];
    }
  }
  return std::all_of(sides.begin(), sides.end(), [](const auto& side) { return side.second == 0; });
}

/// Points in and around the box of the mesh. A random point lies on no face.
std::vector<DVec3> points_around(const Mesh& mesh, std::size_t count) {
  const Bounds box = face_bounds(mesh);
  const DVec3 low(box.low), size = DVec3(box.high) - low;
  Random random(11);
  std::vector<DVec3> points;
  for (std::size_t i = 0; i < count; ++i) {
    points.push_back(low +
                     size * DVec3(random.uniform(-0.1, 1.1), random.uniform(-0.1, 1.1), random.uniform(-0.1, 1.1)));
  }
  return points;
}

void expect_same_winding(const Mesh& mesh, const Shell& shell) {
  for (const DVec3& point : points_around(mesh, 200)) {
    const double before = solid_angle_winding(mesh.positions, mesh.faces, point);
    const double after = solid_angle_winding(shell.positions, shell.faces, point);
    ASSERT_NEAR(before, after, 1e-3);
  }
}

void expect_valid(const Shell& shell, const Mesh& mesh) {
  EXPECT_TRUE(is_closed_manifold(shell.positions, shell.faces));
  ASSERT_EQ(shell.source_face.size(), shell.faces.size());
  ASSERT_EQ(shell.source_vertex.size(), shell.positions.size());
  for (std::size_t v = 0; v < shell.positions.size(); ++v) {
    EXPECT_TRUE(is_finite(shell.positions[v]));
    if (shell.source_vertex[v] == kInvalidId) continue;
    EXPECT_EQ(shell.positions[v], mesh.positions.at(shell.source_vertex[v]));
  }
  for (const FaceId face : shell.source_face)
    EXPECT_TRUE(face == kInvalidId || face < mesh.faces.size());
}

bool has_note(const Shell& shell, std::string_view text) {
  return std::any_of(shell.notes.begin(), shell.notes.end(),
                     [&](const std::string& note) { return note.find(text) != std::string::npos; });
}

TEST(Shell, IsValidOrTellsWhyOnTheWholeStable) {
  for (const StableMesh& entry : awkward_meshes()) {
    SCOPED_TRACE(entry.name);
    const Result<Shell> shell = make_shell(entry.mesh);
    if (!shell) {
      EXPECT_EQ(shell.error().code, ErrorCode::kUnsuitable);
      EXPECT_FALSE(shell.error().message.empty());
      EXPECT_FALSE(shell.error().remedy.empty());
      continue;
    }
    expect_valid(*shell, entry.mesh);
    if (is_balanced(entry.mesh)) expect_same_winding(entry.mesh, *shell);
  }
}

TEST(Shell, RefusesJustTheseOfTheStable) {
  std::map<std::string, std::string> refused;
  for (const StableMesh& entry : awkward_meshes()) {
    const Result<Shell> shell = make_shell(entry.mesh);
    if (!shell) refused[entry.name] = format_error(shell.error());
  }
  const std::map<std::string, std::string> expected{{"sheet", "encloses no volume"},
                                                    {"no vertices", "no faces"},
                                                    {"vertices without faces", "no faces"},
                                                    {"only a degenerate face", "encloses no volume"},
                                                    {"one triangle", "encloses no volume"},
                                                    {"bow tie", "encloses no volume"},
                                                    {"T-junction", "encloses no volume"},
                                                    {"collinear face", "encloses no volume"},
                                                    {"two faces back to back", "encloses no volume"},
                                                    {"flat box", "encloses no volume"},
                                                    {"flipped face", "edge "},
                                                    {"inside out", "its volume is -8"},
                                                    {"Moebius band", "edge "},
                                                    {"Klein bottle", "edge "}};
  for (const auto& [name, message] : refused) {
    ASSERT_TRUE(expected.contains(name)) << name << ": " << message;
    EXPECT_NE(message.find(expected.at(name)), std::string::npos) << name << ": " << message;
  }
  EXPECT_EQ(refused.size(), expected.size());
}

TEST(Shell, OfACleanMeshIsTheMesh) {
  const Mesh mesh = stable_mesh("tetrahedron without attributes");
  const Result<Shell> shell = make_shell(mesh);
  ASSERT_TRUE(shell);
  EXPECT_EQ(shell->positions, mesh.positions);
  EXPECT_EQ(shell->faces, mesh.faces);
  EXPECT_TRUE(shell->notes.empty());
}

TEST(Shell, PartsSolidsThatTouch) {
  const Result<Shell> edge = make_shell(stable_mesh("two tetrahedra sharing an edge"));
  ASSERT_TRUE(edge);
  EXPECT_EQ(edge->positions.size(), 8u);
  EXPECT_TRUE(has_note(*edge, "parted 2 vertices"));
  const Result<Shell> vertex = make_shell(stable_mesh("two tetrahedra sharing a vertex"));
  ASSERT_TRUE(vertex);
  EXPECT_EQ(vertex->positions.size(), 8u);
  EXPECT_TRUE(has_note(*vertex, "parted 1 vertex"));
}

TEST(Shell, PartsManyWedgesAtAnEdgeEachByItself) {
  // Thin tetrahedra about one edge, in any order: parted, each is closed by itself. Wrongly paired, faces of different
  // ones would hang together.
  constexpr int kWedges = 9;
  Mesh mesh;
  mesh.positions = {{0, 0, -1}, {0.3f, 0.1f, 1}};
  std::vector<std::array<double, 2>> wedges;
  for (int i = 0; i < kWedges; ++i)
    wedges.push_back({i * 0.69, i * 0.69 + 0.5});
  Random random(7);
  for (std::size_t i = wedges.size(); i > 1; --i)
    std::swap(wedges[i - 1], wedges[random.below(i)]);
  for (const auto& [from, to] : wedges) {
    const auto first = static_cast<VertexId>(mesh.positions.size());
    for (const double turn : {from, to})
      mesh.positions.emplace_back(std::cos(turn), std::sin(turn), 0);
    const VertexId a = first, b = first + 1;
    for (const Triangle& t : {Triangle{0, 1, b}, Triangle{1, 0, a}, Triangle{0, b, a}, Triangle{1, a, b}})
      mesh.faces.push_back(t);
  }
  const Result<Shell> shell = make_shell(mesh);
  ASSERT_TRUE(shell) << format_error(shell.error());
  expect_valid(*shell, mesh);
  EXPECT_EQ(shell->positions.size(), 4u * kWedges);
}

/// Cubes of side 1 that fill cells, their inner walls left out: what voxels become.
Mesh voxels(const std::vector<std::array<int, 3>>& cells) {
  Mesh mesh;
  const auto full = [&](std::array<int, 3> cell) { return std::find(cells.begin(), cells.end(), cell) != cells.end(); };
  for (const auto& cell : cells) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const int side : {0, 1}) {
        std::array<int, 3> beyond = cell;
        beyond[axis] += side == 1 ? 1 : -1;
        if (full(beyond)) continue;
        const auto corner = [&](int i, int j) {
          std::array<int, 3> p = cell;
          p[axis] += side;
          p[(axis + 1) % 3] += i;
          p[(axis + 2) % 3] += j;
          return Vec3(static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2]));
        };
        const auto first = static_cast<VertexId>(mesh.positions.size());
        for (const auto& [i, j] : {std::pair{0, 0}, std::pair{1, 0}, std::pair{1, 1}, std::pair{0, 1}})
          mesh.positions.push_back(corner(i, j));
        if (side == 1) {
          mesh.faces.push_back({first, first + 1, first + 2});
          mesh.faces.push_back({first, first + 2, first + 3});
        } else {
          mesh.faces.push_back({first, first + 2, first + 1});
          mesh.faces.push_back({first, first + 3, first + 2});
        }
      }
    }
  }
  return mesh;
}

TEST(Shell, PartsAnEdgeBothOfWhoseEndsHoldTogether) {
  // Two columns touch along an edge, between a floor and a roof that join them.
  std::vector<std::array<int, 3>> cells{{0, 0, 1}, {1, 1, 1}};
  for (const int z : {0, 2}) {
    for (const int x : {0, 1}) {
      cells.push_back({x, 0, z});
      cells.push_back({x, 1, z});
    }
  }
  const Mesh mesh = voxels(cells);
  const Result<Shell> shell = make_shell(mesh);
  ASSERT_TRUE(shell) << format_error(shell.error());
  expect_valid(*shell, mesh);
  expect_same_winding(mesh, *shell);
  EXPECT_TRUE(has_note(*shell, "parted 1 edge"));
}

TEST(Shell, OfRandomVoxelsIsValid) {
  Random random(5);
  for (int round = 0; round < 60; ++round) {
    std::vector<std::array<int, 3>> cells;
    for (int i = 0; i < 64; ++i) {
      if (random.below(2) == 0) cells.push_back({i & 3, i >> 2 & 3, i >> 4});
    }
    const Mesh mesh = voxels(cells);
    const Result<Shell> shell = make_shell(mesh);
    ASSERT_TRUE(shell) << format_error(shell.error());
    expect_valid(*shell, mesh);
    if (round < 10) expect_same_winding(mesh, *shell);
  }
}

TEST(Shell, OfRandomSoupIsValidOrRefused) {
  // Few vertices and many faces: every kind of edge there is. A face and its back make the sides even out at random.
  Random random(6);
  std::size_t made = 0;
  for (int round = 0; round < 400; ++round) {
    Mesh mesh;
    for (int i = 0; i < 7; ++i)
      mesh.positions.push_back(random.direction());
    const std::size_t tetrahedra = 1 + random.below(5);
    for (std::size_t i = 0; i < tetrahedra; ++i) {
      std::array<VertexId, 4> v{};
      do {
        for (VertexId& one : v)
          one = static_cast<VertexId>(random.below(7));
      } while (std::set<VertexId>(v.begin(), v.end()).size() < 4);
      const Vec3 a = mesh.positions[v[0]];
      const float turn =
          glm::dot(mesh.positions[v[3]] - a, glm::cross(mesh.positions[v[1]] - a, mesh.positions[v[2]] - a));
      if (turn > 0) std::swap(v[1], v[2]);
      for (const Triangle& t : {Triangle{0, 1, 2}, Triangle{0, 3, 1}, Triangle{1, 3, 2}, Triangle{2, 3, 0}})
        mesh.faces.push_back({v[t[0]], v[t[1]], v[t[2]]});
    }
    const bool whole = round % 2 == 0;
    for (std::size_t drop = whole ? 0 : random.below(4); drop > 0; --drop)
      mesh.faces.erase(mesh.faces.begin() + static_cast<std::ptrdiff_t>(random.below(mesh.faces.size())));
    const Result<Shell> shell = make_shell(mesh);
    if (!shell) {
      EXPECT_FALSE(whole) << format_error(shell.error());
      continue;
    }
    ++made;
    expect_valid(*shell, mesh);
    if (whole) expect_same_winding(mesh, *shell);
  }
  EXPECT_GT(made, 250u);
}

TEST(Shell, ClosesBoundariesWithFacesOfItsOwn) {
  Mesh mesh = *make_shape(Shape::kTorus, {.faces = 800});
  const Result<Shell> whole = make_shell(mesh);
  ASSERT_TRUE(whole);
  Random random(3);
  for (std::size_t holes = 0; holes < 40; ++holes)
    mesh.faces.erase(mesh.faces.begin() + static_cast<std::ptrdiff_t>(random.below(mesh.faces.size())));
  const Result<Shell> shell = make_shell(mesh);
  ASSERT_TRUE(shell) << format_error(shell.error());
  expect_valid(*shell, mesh);
  EXPECT_TRUE(has_note(*shell, "closed "));
  EXPECT_EQ(std::count(shell->source_face.begin(), shell->source_face.end(), kInvalidId),
            static_cast<std::ptrdiff_t>(shell->faces.size() - mesh.faces.size()));
}

TEST(Shell, ClosesALargeHole) {
  // Half a sphere: one loop too long for the exact filling.
  Mesh mesh = *make_shape(Shape::kIcosphere, {.faces = 20480});
  std::erase_if(mesh.faces, [&](const Triangle& t) {
    return mesh.positions[t[0]].y < 0 || mesh.positions[t[1]].y < 0 || mesh.positions[t[2]].y < 0;
  });
  const Result<Shell> shell = make_shell(mesh);
  ASSERT_TRUE(shell) << format_error(shell.error());
  expect_valid(*shell, mesh);
  EXPECT_NEAR(solid_angle_winding(shell->positions, shell->faces, DVec3(0.01, 0.4, 0.02)), 1, 1e-6);
  EXPECT_NEAR(solid_angle_winding(shell->positions, shell->faces, DVec3(0.01, -0.4, 0.02)), 0, 1e-6);
}

TEST(Shell, IsTheSameForAnyNumberOfThreads) {
  Mesh mesh = *make_shape(Shape::kHoles3, {.faces = 5000});
  mesh.faces.resize(mesh.faces.size() - 100);
  const ThreadLimit one(1);
  const Result<Shell> alone = make_shell(mesh);
  const ThreadLimit four(4);
  const Result<Shell> many = make_shell(mesh);
  ASSERT_TRUE(alone && many);
  EXPECT_EQ(alone->positions, many->positions);
  EXPECT_EQ(alone->faces, many->faces);
}

double area_of(std::span<const Vec3> corners, const LoopFilling& filling) {
  double area = 0;
  for (const auto& t : filling.triangles) {
    const auto point = [&](std::uint32_t i) { return DVec3(i < corners.size() ? corners[i] : filling.middle); };
    area += 0.5 * glm::length(glm::cross(point(t[1]) - point(t[0]), point(t[2]) - point(t[0])));
  }
  return area;
}

TEST(FillLoop, CoversFlatLoopsOnce) {
  // A star: an area filled twice would be more than its own.
  for (const std::size_t count : {5u, 20u, 40u, 41u, 300u}) {
    std::vector<Vec3> corners;
    double area = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const double turn = 6.283185307179586 * static_cast<double>(i) / static_cast<double>(count);
      const double radius = i % 2 == 0 ? 1 : 0.8;
      corners.emplace_back(radius * std::cos(turn), radius * std::sin(turn), 0);
    }
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3 &a = corners[i], &b = corners[(i + 1) % count];
      area += 0.5 * (double{a.x} * b.y - double{a.y} * b.x);
    }
    const LoopFilling filling = fill_loop(corners, {});
    EXPECT_EQ(filling.triangles.size(), count - 2);
    EXPECT_NEAR(area_of(corners, filling), area, count > 40 ? 0.2 * area : 1e-6) << count;
  }
}

TEST(FillLoop, KeepsClearOfForbiddenPairs) {
  const std::vector<Vec3> square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const std::vector<std::pair<std::uint32_t, std::uint32_t>> one{{0, 2}}, both{{0, 2}, {1, 3}};
  for (const auto& t : fill_loop(square, one).triangles)
    EXPECT_TRUE(std::count(t.begin(), t.end(), 0u) == 0 || std::count(t.begin(), t.end(), 2u) == 0);
  const LoopFilling middle = fill_loop(square, both);
  EXPECT_TRUE(middle.has_middle);
  EXPECT_EQ(middle.triangles.size(), 4u);
  EXPECT_NEAR(area_of(square, middle), 1, 1e-6);
}

}  // namespace
}  // namespace limn::test
