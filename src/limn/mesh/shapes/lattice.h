#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "limn/base/parallel.h"
#include "limn/mesh/ids.h"

namespace limn::procedural {

/// A point of a subdivided triangle: base corners with integer weights that sum to the lattice's frequency.
struct LatticePoint {
  VertexId corner[3];
  std::uint32_t weight[3];
};

/// Steps from corner 0 of a base face towards corners 1 and 2.
struct LatticeCoord {
  std::uint32_t b, c;
};

/// Every face of a base mesh cut into frequency² congruent triangles (in the plane), points on shared edges and corners
/// numbered once: base vertices first, then the insides of the edges, then the insides of the faces.
class TriangleLattice {
 public:
  /// \pre frequency >= 1, the base is an edge-manifold mesh of fewer than 2^30 / frequency² faces
  TriangleLattice(std::size_t base_vertices, std::span<const Triangle> base_faces, std::uint32_t frequency);

  std::uint32_t frequency() const { return frequency_; }
  std::size_t point_count() const { return first_inner_ + base_faces_.size() * inner_per_face(); }
  std::size_t face_count() const { return base_faces_.size() * frequency_ * frequency_; }

  /// The number of a base face's lattice point.
  VertexId index(std::size_t base_face, LatticeCoord at) const;

  /// Calls body(index, LatticePoint) once for every point, possibly from several threads. A point on a base edge is
  /// described from the edge's lower vertex, so that both sides compute the same bits.
  template <class Body>
  void for_each_point(const Body& body) const;

  /// Calls body(face, base face, p, q, r) once for every small triangle, wound as its base face, possibly from several
  /// threads.
  template <class Body>
  void for_each_triangle(const Body& body) const;

  /// The small triangles.
  std::vector<Triangle> triangles() const;

 private:
  struct BaseEdge {
    VertexId low, high;
  };
  struct EdgeUse {
    std::uint32_t edge;
    bool forward;
  };

  std::size_t inner_per_face() const {
    const std::size_t n = frequency_;
    return n < 3 ? 0 : (n - 1) * (n - 2) / 2;
  }
  VertexId edge_point(const EdgeUse& use, std::uint32_t steps) const;
  /// The number of the first inner point of row c, which holds b = 1 … n-c-1.
  VertexId inner_row(std::size_t base_face, std::uint32_t c) const;

  std::uint32_t frequency_;
  std::size_t base_vertices_;
  std::size_t first_inner_ = 0;
  std::vector<Triangle> base_faces_;
  std::vector<BaseEdge> edges_;
  std::vector<EdgeUse> edge_uses_;  // three a base face
};

template <class Body>
void TriangleLattice::for_each_point(const Body& body) const {
  const std::uint32_t n = frequency_;
  for (VertexId v = 0; v < base_vertices_; ++v)
    body(v, LatticePoint{{v, v, v}, {n, 0, 0}});
  parallel_for(edges_.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      const VertexId first = static_cast<VertexId>(base_vertices_ + e * (n - 1));
      for (std::uint32_t k = 1; k < n; ++k) {
        body(first + k - 1, LatticePoint{{edges_[e].low, edges_[e].high, edges_[e].high}, {n - k, k, 0}});
      }
    }
  });
  if (n < 3) return;
  const std::size_t rows = n - 2;
  parallel_for(base_faces_.size() * rows, 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t item = begin; item < end; ++item) {
      const std::size_t face = item / rows;
      const auto c = static_cast<std::uint32_t>(1 + item % rows);
      const Triangle& t = base_faces_[face];
      const VertexId first = inner_row(face, c);
      for (std::uint32_t b = 1; b + c < n; ++b)
        body(first + b - 1, LatticePoint{{t[0], t[1], t[2]}, {n - b - c, b, c}});
    }
  });
}

template <class Body>
void TriangleLattice::for_each_triangle(const Body& body) const {
  const std::size_t n = frequency_;
  parallel_for(base_faces_.size() * n, 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t item = begin; item < end; ++item) {
      const std::size_t base = item / n;
      const auto c = static_cast<std::uint32_t>(item % n);
      std::size_t face = base * n * n + 2 * n * c - static_cast<std::size_t>(c) * c;
      for (std::uint32_t b = 0; b + c < n; ++b) {
        body(face++, base, LatticeCoord{b, c}, LatticeCoord{b + 1, c}, LatticeCoord{b, c + 1});
        if (b + c + 1 < n)
          body(face++, base, LatticeCoord{b + 1, c}, LatticeCoord{b + 1, c + 1}, LatticeCoord{b, c + 1});
      }
    }
  });
}

}  // namespace limn::procedural
