#include <algorithm>
#include <array>

#include "limn/base/parallel.h"
#include "limn/mesh/shapes/builders.h"
#include "limn/mesh/shapes/lattice.h"

namespace limn::procedural {
namespace {

/// The tetrahedron's corners and faces, and where each face lies in the unfolded picture: face 0 in the middle of a big
/// triangle, the others folded out along its edges.
constexpr std::array<Vec3, 4> kCorners{Vec3(0.5f, 0.5f, 0.5f), Vec3(-0.5f, 0.5f, -0.5f), Vec3(-0.5f, -0.5f, 0.5f),
                                       Vec3(0.5f, -0.5f, -0.5f)};
constexpr std::array<Triangle, 4> kFaces{{{0, 1, 2}, {1, 0, 3}, {2, 1, 3}, {0, 2, 3}}};
constexpr std::array<std::array<Vec2, 3>, 4> kNet{{{Vec2(0.5f, 0), Vec2(0.75f, 0.5f), Vec2(0.25f, 0.5f)},
                                                   {Vec2(0.75f, 0.5f), Vec2(0.5f, 0), Vec2(1, 0)},
                                                   {Vec2(0.25f, 0.5f), Vec2(0.75f, 0.5f), Vec2(0.5f, 1)},
                                                   {Vec2(0.5f, 0), Vec2(0.25f, 0.5f), Vec2(0, 0)}}};

/// The mean of three values with a lattice point's integer weights.
template <class V>
V blend(const V& p, const V& q, const V& r, const std::uint32_t (&weight)[3], std::uint32_t frequency) {
  return (p * static_cast<double>(weight[0]) + q * static_cast<double>(weight[1]) +
          r * static_cast<double>(weight[2])) /
         static_cast<double>(frequency);
}

/// Places of a face's lattice points in a list of its own, row by row of constant c.
std::size_t net_index(std::uint32_t frequency, LatticeCoord at) {
  const std::size_t n = frequency, c = at.c;
  return c * (n + 1) - c * (c - 1) / 2 + at.b;
}

void fill_net_uvs(Mesh& mesh, const TriangleLattice& lattice) {
  const std::uint32_t n = lattice.frequency();
  const std::size_t per_face = static_cast<std::size_t>(n + 1) * (n + 2) / 2;
  for (const auto& net : kNet) {
    for (std::uint32_t c = 0; c <= n; ++c) {
      for (std::uint32_t b = 0; b + c <= n; ++b) {
        using DVec2 = glm::dvec2;
        mesh.uvs.values.emplace_back(blend(DVec2(net[0]), DVec2(net[1]), DVec2(net[2]), {n - b - c, b, c}, n));
      }
    }
  }
  mesh.uvs.indices.resize(3 * mesh.faces.size());
  lattice.for_each_triangle([&](std::size_t face, std::size_t base, LatticeCoord p, LatticeCoord q, LatticeCoord r) {
    const std::array<LatticeCoord, 3> corners{p, q, r};
    for (std::size_t c = 0; c < 3; ++c) {
      mesh.uvs.indices[3 * face + c] = static_cast<std::uint32_t>(base * per_face + net_index(n, corners[c]));
    }
  });
}

/// Gives the faces one normal a side; faces of a side follow one another.
void fill_side_normals(Mesh& mesh, std::size_t faces_per_side) {
  mesh.normals.indices.resize(3 * mesh.faces.size());
  for (std::size_t i = 0; i < mesh.normals.indices.size(); ++i) {
    mesh.normals.indices[i] = static_cast<std::uint32_t>(i / (3 * faces_per_side));
  }
}

/// Integer points on the surface of the cube [0, n]³, numbered layer by layer: whole squares at both ends, rings
/// between.
struct CubeNumbering {
  std::size_t n;

  std::size_t square() const { return (n + 1) * (n + 1); }
  std::size_t count() const { return 2 * square() + (n - 1) * 4 * n; }
  std::size_t ring(std::size_t i, std::size_t j) const {
    if (j == 0 && i < n) return i;
    if (i == n && j < n) return n + j;
    if (j == n && i > 0) return 2 * n + (n - i);
    return 3 * n + (n - j);
  }
  std::size_t operator()(const std::array<std::size_t, 3>& p) const {
    if (p[2] == 0) return p[1] * (n + 1) + p[0];
    if (p[2] == n) return square() + (n - 1) * 4 * n + p[1] * (n + 1) + p[0];
    return square() + (p[2] - 1) * 4 * n + ring(p[0], p[1]);
  }
};

/// One side of the cube: its axis and whether it is the upper one; s and t run along the other axes so that s × t
/// points out.
struct CubeSide {
  std::size_t axis, s, t;
  bool upper;
  bool mirrored;  ///< s runs downwards
};

constexpr std::array<CubeSide, 6> kSides{{{0, 2, 1, true, true},
                                          {0, 2, 1, false, false},
                                          {1, 0, 2, true, false},
                                          {1, 0, 2, false, true},
                                          {2, 0, 1, true, false},
                                          {2, 0, 1, false, true}}};

}  // namespace

Mesh tetrahedron(std::size_t faces) {
  const TriangleLattice lattice(kCorners.size(), kFaces, nearest_frequency(faces, kFaces.size()));
  Mesh mesh;
  mesh.faces = lattice.triangles();
  mesh.positions.resize(lattice.point_count());
  lattice.for_each_point([&](VertexId index, const LatticePoint& at) {
    const DVec3 p(kCorners[at.corner[0]]), q(kCorners[at.corner[1]]), r(kCorners[at.corner[2]]);
    mesh.positions[index] = Vec3(blend(p, q, r, at.weight, lattice.frequency()));
  });
  // A face's normal points away from the corner it does not touch.
  const float length = std::sqrt(1.0f / 3.0f);
  for (const VertexId opposite : {3u, 2u, 0u, 1u})
    mesh.normals.values.push_back(kCorners[opposite] * (-2.0f * length));
  fill_side_normals(mesh, mesh.faces.size() / kFaces.size());
  fill_net_uvs(mesh, lattice);
  return mesh;
}

Mesh cube(std::size_t faces) {
  const std::size_t n = nearest_frequency(faces, 12);
  const CubeNumbering number{n};
  const auto coordinate = [n](std::size_t i) {
    return static_cast<float>(static_cast<double>(i) / static_cast<double>(n) - 0.5);
  };
  Mesh mesh;
  mesh.positions.resize(number.count());
  for (const CubeSide& side : kSides) {
    const auto corner = [&](std::size_t s, std::size_t t) {
      std::array<std::size_t, 3> p{};
      p[side.axis] = side.upper ? n : 0;
      p[side.s] = side.mirrored ? n - s : s;
      p[side.t] = side.axis == 1 ? n - t : t;
      const std::size_t index = number(p);
      mesh.positions[index] = Vec3(coordinate(p[0]), coordinate(p[1]), coordinate(p[2]));
      return static_cast<VertexId>(index);
    };
    for (std::size_t s = 0; s < n; ++s) {
      for (std::size_t t = 0; t < n; ++t) {
        const VertexId a = corner(s, t), b = corner(s + 1, t), c = corner(s + 1, t + 1), d = corner(s, t + 1);
        mesh.faces.push_back({a, b, c});
        mesh.faces.push_back({a, c, d});
        const auto uv = [n](std::size_t i, std::size_t j) { return static_cast<std::uint32_t>(i * (n + 1) + j); };
        for (const std::uint32_t i :
             {uv(s, t), uv(s + 1, t), uv(s + 1, t + 1), uv(s, t), uv(s + 1, t + 1), uv(s, t + 1)}) {
          mesh.uvs.indices.push_back(i);
        }
      }
    }
    Vec3 normal(0);
    normal[static_cast<int>(side.axis)] = side.upper ? 1.0f : -1.0f;
    mesh.normals.values.push_back(normal);
  }
  for (std::size_t s = 0; s <= n; ++s) {
    for (std::size_t t = 0; t <= n; ++t)
      mesh.uvs.values.emplace_back(coordinate(s) + 0.5f, coordinate(t) + 0.5f);
  }
  fill_side_normals(mesh, 2 * n * n);
  return mesh;
}

}  // namespace limn::procedural
