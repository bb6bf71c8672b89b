#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "limn/base/vec.h"
#include "limn/hull/hull_step.h"
#include "limn/hull/placement.h"
#include "limn/hull/shell.h"
#include "limn/mesh/ids.h"

namespace limn {

/// A neighbour of a vertex, and the face between it and the next neighbour.
struct RingLink {
  VertexId vertex;
  FaceId face;
};

/// A closed surface of vertices that each know their neighbours in order, counter-clockwise seen from outside: what
/// edge collapses and flips need, and nothing else. The faces of vertex v are (v, ring[i], ring[i + 1]).
class RingSurface {
 public:
  /// \param flip  turn the shell inside out
  /// \pre shell is closed and manifold (shell.h)
  RingSurface(const Shell& shell, bool flip);

  std::size_t vertex_count() const { return positions_.size(); }
  std::size_t face_ids() const { return planes_.size(); }
  std::size_t live_faces() const { return live_faces_; }
  bool alive(VertexId v) const { return slots_[v].degree != 0; }
  std::uint32_t degree(VertexId v) const { return slots_[v].degree; }
  std::span<const RingLink> ring(VertexId v) const { return {links_.data() + slots_[v].begin, slots_[v].degree}; }
  std::span<const Vec3> positions() const { return positions_; }
  const Vec3& position(VertexId v) const { return positions_[v]; }
  std::span<const FacePlane> planes() const { return planes_; }
  const FacePlane& plane(FaceId f) const { return planes_[f]; }
  /// Place of a neighbour in the ring of v; degree(v) where it is none.
  std::uint32_t find(VertexId v, VertexId neighbour) const;

  /// Coordinates times this are at most 1; a power of two.
  double scale() const { return scale_; }

  /// The step that would collapse edge (kept, removed) to `after`. \pre they are neighbours
  HullStep collapse_step(VertexId kept, VertexId removed, const Vec3& after) const;
  /// The step that would turn the edge. \pre they are neighbours
  HullStep flip_step(VertexId a, VertexId b) const;

  /// Whether the surface stays a closed manifold without double edges when the edge collapses.
  bool can_collapse(VertexId kept, VertexId removed) const;
  bool can_flip(VertexId a, VertexId b) const;
  /// A third vertex that both ends of an edge are joined to, though it is no face: kInvalidId where there is none.
  VertexId waist(VertexId a, VertexId b) const;
  HullStep cut_step(VertexId a, VertexId b, VertexId c) const;
  /// The vertices of the part that v belongs to, v first.
  std::vector<VertexId> part_of(VertexId v) const;

  /// Carries out a step. \pre it fits: can_collapse or can_flip, a waist, a live vertex
  void apply(const HullStep& step);

  /// The live faces as corners, in ascending order of their ids; `ids` gets those.
  std::vector<Triangle> faces(std::vector<FaceId>& ids) const;

 private:
  struct Slot {
    std::uint32_t begin = 0, degree = 0, capacity = 0;
  };

  void link_faces(const std::vector<Triangle>& faces, bool flip);
  void sort_ring(VertexId v, const std::vector<Triangle>& faces, bool flip);
  void compute_all_planes();
  void collapse(const HullStep& step);
  void flip(const HullStep& step);
  void remove_part(VertexId v);
  void cut(const HullStep& step);
  void cut_ring(const HullStep& step, int corner);
  RingLink& link(VertexId v, VertexId neighbour);
  RingLink erase(VertexId v, VertexId neighbour);
  void insert_after(VertexId v, VertexId neighbour, const RingLink& link);
  void store_ring(VertexId v, std::span<const RingLink> ring);
  void update_plane(VertexId v, const RingLink& link, VertexId next);
  void update_planes(VertexId v);

  std::vector<Vec3> positions_;
  std::vector<Slot> slots_;
  std::vector<RingLink> links_;
  std::vector<FacePlane> planes_;
  std::vector<RingLink> scratch_;
  std::size_t live_faces_ = 0;
  double scale_ = 1.0;
};

}  // namespace limn
