#include "limn/mesh/shapes/lattice.h"

#include <algorithm>
#include <utility>

namespace limn::procedural {

TriangleLattice::TriangleLattice(std::size_t base_vertices, std::span<const Triangle> base_faces,
                                 std::uint32_t frequency)
    : frequency_(frequency), base_vertices_(base_vertices), base_faces_(base_faces.begin(), base_faces.end()) {
  using Key = std::pair<VertexId, VertexId>;
  std::vector<Key> keys;
  keys.reserve(3 * base_faces_.size());
  for (const Triangle& t : base_faces_) {
    for (std::size_t c = 0; c < 3; ++c)
      keys.push_back(std::minmax({t[c], t[(c + 1) % 3]}));
  }
  std::vector<Key> sorted = keys;
  std::sort(sorted.begin(), sorted.end());
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  for (const Key& key : sorted)
    edges_.push_back({key.first, key.second});
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const auto place = std::lower_bound(sorted.begin(), sorted.end(), keys[i]);
    edge_uses_.push_back(
        {static_cast<std::uint32_t>(place - sorted.begin()), base_faces_[i / 3][i % 3] == keys[i].first});
  }
  first_inner_ = base_vertices_ + edges_.size() * (frequency_ - 1);
}

VertexId TriangleLattice::edge_point(const EdgeUse& use, std::uint32_t steps) const {
  const std::uint32_t k = use.forward ? steps : frequency_ - steps;
  return static_cast<VertexId>(base_vertices_ + static_cast<std::size_t>(use.edge) * (frequency_ - 1) + k - 1);
}

VertexId TriangleLattice::inner_row(std::size_t base_face, std::uint32_t c) const {
  const std::size_t rows = c - 1;
  return static_cast<VertexId>(first_inner_ + base_face * inner_per_face() + rows * (frequency_ - 1) - rows * c / 2);
}

VertexId TriangleLattice::index(std::size_t base_face, LatticeCoord at) const {
  const std::uint32_t a = frequency_ - at.b - at.c;
  const Triangle& t = base_faces_[base_face];
  if (a == frequency_) return t[0];
  if (at.b == frequency_) return t[1];
  if (at.c == frequency_) return t[2];
  if (at.c == 0) return edge_point(edge_uses_[3 * base_face], at.b);
  if (a == 0) return edge_point(edge_uses_[3 * base_face + 1], at.c);
  if (at.b == 0) return edge_point(edge_uses_[3 * base_face + 2], a);
  return inner_row(base_face, at.c) + at.b - 1;
}

std::vector<Triangle> TriangleLattice::triangles() const {
  std::vector<Triangle> faces(face_count());
  for_each_triangle([&](std::size_t face, std::size_t base, LatticeCoord p, LatticeCoord q, LatticeCoord r) {
    faces[face] = {index(base, p), index(base, q), index(base, r)};
  });
  return faces;
}

}  // namespace limn::procedural
