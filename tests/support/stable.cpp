#include "support/stable.h"

#include <cmath>
#include <cstddef>
#include <gtest/gtest.h>
#include <numbers>
#include <utility>

#include "limn/mesh/shapes.h"

namespace limn::test {
namespace {

Mesh shape(Shape kind, std::size_t faces) {
  Result<Mesh> made = make_shape(kind, {faces, 1});
  EXPECT_TRUE(made.has_value());
  return made ? std::move(*made) : Mesh{};
}

Mesh bare(std::vector<Vec3> positions, std::vector<Triangle> faces) {
  Mesh mesh;
  mesh.positions = std::move(positions);
  mesh.faces = std::move(faces);
  return mesh;
}

/// A tetrahedron without attributes: outward faces, corners at the origin and one step along each axis.
Mesh corner_tetrahedron() {
  return bare({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}});
}

/// A cube of side 2 about the origin without attributes, 8 vertices.
Mesh plain_cube() {
  return bare({{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}},
              {{0, 2, 1},
               {0, 3, 2},
               {4, 5, 6},
               {4, 6, 7},
               {0, 1, 5},
               {0, 5, 4},
               {2, 3, 7},
               {2, 7, 6},
               {0, 4, 7},
               {0, 7, 3},
               {1, 2, 6},
               {1, 6, 5}});
}

Mesh moved(Mesh mesh, float scale, const Vec3& offset) {
  for (Vec3& p : mesh.positions)
    p = p * scale + offset;
  return mesh;
}

Mesh turned_inside_out(Mesh mesh) {
  for (Triangle& t : mesh.faces)
    std::swap(t[1], t[2]);
  return mesh;
}

/// Two meshes without attributes in one.
Mesh joined(Mesh mesh, const Mesh& other) {
  const auto first = static_cast<VertexId>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
  for (const Triangle& t : other.faces)
    mesh.faces.push_back({t[0] + first, t[1] + first, t[2] + first});
  return mesh;
}

/// Three vertices of its own for every face, as STL stores it.
Mesh soup(const Mesh& mesh) {
  Mesh result;
  for (const Triangle& t : mesh.faces) {
    const auto first = static_cast<VertexId>(result.positions.size());
    for (const VertexId v : t)
      result.positions.push_back(mesh.positions[v]);
    result.faces.push_back({first, first + 1, first + 2});
  }
  return result;
}

/// A vertex wherever a corner's position and normal differ, as glTF stores it.
Mesh split_at_normals(const Mesh& mesh) {
  Mesh result = soup(mesh);
  for (FaceId face = 0; face < mesh.faces.size(); ++face) {
    for (int c = 0; c < 3; ++c) {
      result.normals.values.push_back(mesh.corner(mesh.normals, face, c));
      result.uvs.values.push_back(mesh.corner(mesh.uvs, face, c));
    }
  }
  return result;
}

Mesh degenerate_faces() {
  Mesh mesh = plain_cube();
  mesh.positions.push_back(mesh.positions[3]);
  mesh.faces.push_back({0, 0, 1});  // two corners of one index
  mesh.faces.push_back({5, 5, 5});  // three
  mesh.faces.push_back({3, 8, 6});  // two indices at one place
  return mesh;
}

/// A quad whose middle line is closed by a face without area: three distinct collinear corners.
Mesh collinear_face() {
  return bare({{0, 0, 0}, {2, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, -1, 0}}, {{0, 2, 3}, {2, 1, 3}, {0, 1, 2}, {1, 0, 4}});
}

Mesh duplicate_faces() {
  Mesh mesh = corner_tetrahedron();
  mesh.faces.push_back({1, 2, 3});  // as it is
  mesh.faces.push_back({2, 3, 1});  // rotated
  mesh.faces.push_back({0, 1, 2});  // turned over
  return mesh;
}

/// Three pages of a book.
Mesh three_fins() {
  return bare({{0, 0, 0}, {0, 1, 0}, {1, 0.5f, 0}, {-1, 0.5f, 0.5f}, {-1, 0.5f, -0.5f}},
              {{0, 1, 2}, {1, 0, 3}, {1, 0, 4}});
}

/// Two tetrahedra on either side of a plane that share two of their vertices.
Mesh two_sharing_an_edge() {
  Mesh mesh = corner_tetrahedron();
  mesh.positions.insert(mesh.positions.end(), {{-1, 0, 0.25f}, {0, -1, 0.25f}});
  for (const Triangle& t : {Triangle{0, 3, 4}, Triangle{0, 5, 3}, Triangle{0, 4, 5}, Triangle{3, 5, 4}})
    mesh.faces.push_back(t);
  return mesh;
}

Mesh two_sharing_a_vertex() {
  return joined(corner_tetrahedron(), turned_inside_out(moved(corner_tetrahedron(), -1, Vec3(0))));
}

/// Two fans of an open surface that meet in one vertex.
Mesh bow_tie() {
  return bare({{0, 0, 0}, {1, 1, 0}, {1, -1, 0}, {-1, 1, 0}, {-1, -1, 0}}, {{0, 2, 1}, {0, 3, 4}});
}

/// A strip of quads closed with half a turn.
Mesh moebius_band() {
  constexpr std::uint32_t kSteps = 24;
  Mesh mesh;
  for (std::uint32_t i = 0; i < kSteps; ++i) {
    const double around = 2 * std::numbers::pi * i / kSteps;
    for (const double side : {-0.3, 0.3}) {
      const double radius = 1 + side * std::cos(around / 2);
      mesh.positions.emplace_back(radius * std::cos(around), radius * std::sin(around), side * std::sin(around / 2));
    }
  }
  for (std::uint32_t i = 0; i < kSteps; ++i) {
    const bool last = i + 1 == kSteps;
    const VertexId a = 2 * i, b = 2 * i + 1, c = last ? 0 : 2 * i + 3, d = last ? 1 : 2 * i + 2;
    mesh.faces.push_back({a, d, c});
    mesh.faces.push_back({a, c, b});
  }
  return mesh;
}

/// A tube closed onto itself mirrored (the figure-8 immersion): every edge has two faces, no consistent winding exists.
Mesh klein_bottle() {
  constexpr std::uint32_t kAround = 20, kAcross = 14;
  Mesh mesh;
  for (std::uint32_t i = 0; i < kAround; ++i) {
    const double u = 2 * std::numbers::pi * i / kAround;
    for (std::uint32_t j = 0; j < kAcross; ++j) {
      const double v = 2 * std::numbers::pi * (j + 0.5) / kAcross;
      const double x = 0.5 * std::sin(v), y = 0.4 * std::sin(2 * v);
      const double radius = 2 + x * std::cos(u / 2) - y * std::sin(u / 2);
      mesh.positions.emplace_back(radius * std::cos(u), radius * std::sin(u),
                                  x * std::sin(u / 2) + y * std::cos(u / 2));
    }
  }
  // One turn on, u / 2 has grown by π and (x, y) has changed its sign: v is -v there.
  const auto number = [](std::uint32_t i, std::uint32_t j) {
    return i < kAround ? i * kAcross + j % kAcross : (2 * kAcross - 1 - j) % kAcross;
  };
  for (std::uint32_t i = 0; i < kAround; ++i) {
    for (std::uint32_t j = 0; j < kAcross; ++j) {
      const VertexId a = number(i, j), b = number(i + 1, j), c = number(i + 1, j + 1), d = number(i, j + 1);
      mesh.faces.push_back({a, b, c});
      mesh.faces.push_back({a, c, d});
    }
  }
  return mesh;
}

/// Two triangles along one edge, met on its other side by a single longer one.
Mesh t_junction() {
  return bare({{0, 0, 0}, {2, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, -1, 0}}, {{0, 2, 3}, {2, 1, 3}, {1, 0, 4}});
}

/// A closed spindle a million times longer than it is thick.
Mesh needles() {
  return bare({{0, 0, -1}, {0, 0, 1}, {1e-6f, 0, 0}, {-1e-6f, 1e-6f, 0}, {0, -1e-6f, 0.1f}},
              {{0, 3, 2}, {0, 4, 3}, {0, 2, 4}, {1, 2, 3}, {1, 3, 4}, {1, 4, 2}});
}

Mesh one_face_flipped() {
  Mesh mesh = shape(Shape::kIcosphere, 80);
  mesh.normals = {};
  mesh.uvs = {};
  std::swap(mesh.faces[7][1], mesh.faces[7][2]);
  return mesh;
}

Mesh self_intersecting() {
  return joined(corner_tetrahedron(), moved(corner_tetrahedron(), 1, Vec3(0.125f, 0.0625f, 0.03125f)));
}

/// A cone of many faces around one vertex.
Mesh high_valence() {
  constexpr std::uint32_t kFaces = 400;
  Mesh mesh;
  mesh.positions = {{0, 1, 0}, {0, 0, 0}};
  for (std::uint32_t i = 0; i < kFaces; ++i) {
    const double around = 2 * std::numbers::pi * i / kFaces;
    mesh.positions.emplace_back(std::cos(around), 0.0, std::sin(around));
  }
  for (std::uint32_t i = 0; i < kFaces; ++i) {
    const VertexId a = 2 + i, b = 2 + (i + 1) % kFaces;
    mesh.faces.push_back({0, b, a});
    mesh.faces.push_back({1, a, b});
  }
  return mesh;
}

/// A tetrahedron stored as a soup whose zeros have both signs.
Mesh both_zeros() {
  Mesh mesh = soup(corner_tetrahedron());
  for (std::size_t i = 0; i < mesh.positions.size(); i += 2) {
    Vec3& p = mesh.positions[i];
    for (int axis = 0; axis < 3; ++axis) {
      if (p[axis] == 0.0f) p[axis] = -0.0f;
    }
  }
  return mesh;
}

Mesh every_attribute() {
  Mesh mesh = shape(Shape::kCube, 48);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    mesh.tags.push_back(static_cast<float>(v) / static_cast<float>(mesh.positions.size()));
    mesh.colors.values.emplace_back(mesh.positions[v] + 0.5f, 1.0f);
  }
  mesh.materials.resize(2);
  mesh.materials[0].name = "plain";
  mesh.materials[1].name = "red";
  mesh.materials[1].base_color = Vec4(0.8f, 0.1f, 0.1f, 1.0f);
  for (std::size_t face = 0; face < mesh.faces.size(); ++face)
    mesh.face_materials.push_back(face % 3 == 0 ? 1 : 0);
  return mesh;
}

Mesh stray_vertices() {
  Mesh mesh = moved(corner_tetrahedron(), 1, Vec3(0));
  mesh.positions.insert(mesh.positions.begin(), Vec3(100, 100, 100));
  mesh.positions.emplace_back(-100, 0, 0);
  for (Triangle& t : mesh.faces)
    t = {t[0] + 1, t[1] + 1, t[2] + 1};
  return mesh;
}

std::vector<StableMesh> well_behaved() {
  return {
      {"sheet", shape(Shape::kSheet, 60), false, true},
      {"cube with hard edges", shape(Shape::kCube, 48), true, true},
      {"cube split at normals", split_at_normals(shape(Shape::kCube, 12)), true, true},
      {"sphere with a texture seam", shape(Shape::kIcosphere, 180), true, true},
      {"sphere split at its seam", split_at_normals(shape(Shape::kIcosphere, 80)), true, true},
      {"torus", shape(Shape::kTorus, 200), true, true},
      {"coarse knot", shape(Shape::kKnot, 300), true, true},
      {"three holes", shape(Shape::kHoles3, 400), true, true},
      {"asteroid", shape(Shape::kAsteroid, 320), true, true},
      {"every attribute", every_attribute(), true, true},
      {"tetrahedron without attributes", corner_tetrahedron(), true, true},
      {"one triangle", bare({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}), false, true},
      {"soup cube", soup(plain_cube()), true, true},
      {"zeros of both signs", both_zeros(), true, true},
      {"high valence", high_valence(), true, true},
      {"two components", joined(plain_cube(), moved(corner_tetrahedron(), 1, Vec3(5, 0, 0))), true, true},
      {"stray vertices", stray_vertices(), true, true},
  };
}

std::vector<StableMesh> badly_connected() {
  return {
      {"no vertices", {}, false, true},
      {"vertices without faces", bare({{0, 0, 0}, {1, 0, 0}}, {}), false, true},
      {"degenerate faces", degenerate_faces(), true, true},
      {"only a degenerate face", bare({{0, 0, 0}, {1, 0, 0}}, {{0, 1, 0}}), false, true},
      {"collinear face", collinear_face(), false, true},
      {"duplicate faces", duplicate_faces(), false, false},
      {"two faces back to back", bare({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}), true, true},
      {"three fins on an edge", three_fins(), false, false},
      {"two tetrahedra sharing an edge", two_sharing_an_edge(), false, false},
      {"two tetrahedra sharing a vertex", two_sharing_a_vertex(), true, true},
      {"bow tie", bow_tie(), false, true},
      {"T-junction", t_junction(), false, true},
      {"flipped face", one_face_flipped(), true, true},
      {"inside out", turned_inside_out(plain_cube()), true, true},
      {"Moebius band", moebius_band(), false, true},
      {"Klein bottle", klein_bottle(), true, true},
  };
}

std::vector<StableMesh> badly_placed() {
  const Mesh cavity = turned_inside_out(moved(plain_cube(), 0.5f, Vec3(0)));
  return {
      {"shell with a cavity", joined(plain_cube(), cavity), true, true},
      {"shell in a shell", joined(plain_cube(), moved(plain_cube(), 0.5f, Vec3(0))), true, true},
      {"self-intersection", self_intersecting(), true, true},
      {"needles", needles(), true, true},
      {"coordinates of 1e30", moved(shape(Shape::kIcosphere, 80), 1e30f, Vec3(0)), true, true},
      {"coordinates of 1e-30", moved(shape(Shape::kIcosphere, 80), 1e-30f, Vec3(0)), true, true},
      {"subnormal coordinates", moved(corner_tetrahedron(), 1e-41f, Vec3(0)), true, true},
      {"far from the origin", moved(plain_cube(), 1, Vec3(1e7f, -1e7f, 1e7f)), true, true},
      {"flat box", bare({{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}}, {{0, 2, 1}, {0, 3, 2}, {0, 1, 2}, {0, 2, 3}}),
       false, false},
  };
}

}  // namespace

std::vector<StableMesh> awkward_meshes() {
  std::vector<StableMesh> all = well_behaved();
  for (auto* group : {&badly_connected, &badly_placed}) {
    for (StableMesh& mesh : (*group)())
      all.push_back(std::move(mesh));
  }
  return all;
}

}  // namespace limn::test
