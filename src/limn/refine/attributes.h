#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "limn/mesh/mesh.h"
#include "limn/mesh/topology.h"
#include "limn/refine/patch.h"
#include "limn/refine/patterns/pattern.h"

namespace limn {

/// Carries one corner attribute of a mesh to its tessellation.
///
/// New values lie in three runs: the input's own, edge by edge (once for all faces at the edge where their ends' values
/// agree, else once a face), face by face. Used by tessellate(); fill_edge and fill_interior may run concurrently for
/// different edges and faces. T is Vec2 or Vec4, interpolated linearly, or Vec3, normals, quadratically (Vlachos et al.
/// 2001).
template <class T>
class AttributeTessellator {
 public:
  /// \param edge_levels  t of each edge, which has 2^t segments; \param interior_offsets  vertices inside all faces
  /// before each, one more than faces
  AttributeTessellator(const Mesh& mesh, const Topology& topology, const CornerAttribute<T>& input,
                       std::span<const std::uint8_t> edge_levels, std::span<const std::uint64_t> interior_offsets,
                       std::size_t output_faces);

  bool empty() const { return input_.empty(); }

  void fill_edge(EdgeId edge);
  /// \param points  the face's vertices inside, by their weights at its corners
  void fill_interior(FaceId face, std::span<const PatternVertex> points);

  /// Output index of corner c of the face, of the point q segments of 2^t along its side c (0 < q < 2^t), of its n-th
  /// interior vertex.
  std::uint32_t corner(FaceId face, int c) const { return mesh_.corner_index(input_, face, c); }
  std::uint32_t on_side(FaceId face, int c, int q) const;
  std::uint32_t interior(FaceId face, std::size_t n) const {
    return static_cast<std::uint32_t>(interior_base_ + interior_offsets_[face] + n);
  }

  /// Sets the value of an output face's corner.
  void set_index(std::size_t output_corner, std::uint32_t index) { output_.indices[output_corner] = index; }

  CornerAttribute<T> take() { return std::move(output_); }

 private:
  std::size_t slot(EdgeId edge, FaceId face) const;
  std::size_t segments(EdgeId edge) const { return std::size_t{1} << edge_levels_[edge]; }

  const Mesh& mesh_;
  const Topology& topology_;
  const CornerAttribute<T>& input_;
  std::span<const std::uint8_t> edge_levels_;
  std::span<const std::uint64_t> interior_offsets_;
  std::vector<std::uint64_t> edge_offsets_;  ///< where each edge's run begins, one more than edges
  std::vector<std::uint8_t> shared_;         ///< whether all faces at the edge share its run
  std::uint64_t interior_base_ = 0;
  CornerAttribute<T> output_;
};

}  // namespace limn
