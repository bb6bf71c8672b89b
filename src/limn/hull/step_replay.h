#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "limn/base/vec.h"
#include "limn/hull/hull_step.h"
#include "limn/mesh/ids.h"

namespace limn {

/// A corner of a face (3 * face + c) that a step gives to another vertex.
struct CornerChange {
  std::uint32_t corner;
  VertexId from, to;
};

/// Whether the faces are a closed manifold over `vertices` vertices, by their ids: every edge has two faces that run
/// along it in opposite directions, no two edges have the same ends, every vertex is used and has one fan, indices are
/// in range. Cost: a few linear passes.
bool is_closed_manifold(std::size_t vertices, std::span<const Triangle> faces);

/// What a step changes of a surface's faces.
struct StepChanges {
  std::vector<CornerChange> corners;  ///< in order
  std::vector<FaceId> killed;         ///< faces
  std::vector<VertexId> vanished;     ///< vertices that go without an heir
  void clear() {
    corners.clear();
    killed.clear();
    vanished.clear();
  }
};

/// Inner hulls are made from the shell turned inside out. turned_faces: each face (a, c, b). turned_step: a step in the
/// shell's orientation as it is on the turned one, and back (hull_step.h); cuts are given on the turned one already.
std::vector<Triangle> turned_faces(std::span<const Triangle> faces);
HullStep turned_step(const HullStep& step);

/// Carries out steps on a surface, whoever made them: each is looked at first, so that the surface stays a closed
/// manifold and no index leaves its range. Cuts make vertices and faces at the end of the lists.
class StepReplay {
 public:
  /// \pre is_closed_manifold(positions.size(), faces)
  StepReplay(std::vector<Vec3> positions, std::vector<Triangle> faces);

  std::size_t face_count() const { return live_faces_; }
  const std::vector<Vec3>& positions() const { return positions_; }
  const std::vector<Triangle>& faces() const { return faces_; }  ///< dead ones included
  bool is_alive(FaceId face) const { return alive_[face] != 0; }

  /// The step over the edge that starts at a corner of a live face: kept → removed. Nothing where there is no such
  /// corner. \pre kind is kCollapse or kFlip
  std::optional<HullStep> step_at(HullStep::Kind kind, std::uint32_t corner, const Vec3& after) const;
  /// The cut along that edge and on to a third vertex.
  std::optional<HullStep> cut_at(std::uint32_t corner, VertexId third) const;
  /// The step that moves a vertex, or takes the part away that it belongs to. Nothing where there is no such vertex
  /// alive. \pre kind is kMove, kFill or kDrop
  std::optional<HullStep> step_of(HullStep::Kind kind, VertexId vertex, const Vec3& after) const;

  /// The corner of `a` from which a side runs to b; kInvalidId where they are not joined. \pre a is alive
  std::uint32_t corner_running(VertexId a, VertexId b) const;

  /// Why the step cannot be taken here; empty when it can. Whether it moves the surface outwards is not asked.
  /// Cost: in proportion to the faces around the edge.
  std::string_view objection(const HullStep& step);

  /// \param changes  what it changes is added here
  /// \pre objection(step).empty()
  void apply(const HullStep& step, StepChanges& changes);

 private:
  bool runs(FaceId face, VertexId a, VertexId b, VertexId c) const;
  std::string_view edge_objection(const HullStep& step);
  std::string_view cut_objection(const HullStep& step) const;
  void flip(const HullStep& step, StepChanges& changes);
  void collapse(const HullStep& step, StepChanges& changes);
  void cut(const HullStep& step, StepChanges& changes);
  void remove_part(VertexId vertex, StepChanges& changes);
  std::size_t common_neighbours(VertexId a, VertexId b);
  std::size_t degree(VertexId v) const;
  std::size_t faces_of_part(VertexId vertex);
  bool are_joined(VertexId a, VertexId b) const;
  void link(std::uint32_t corner, VertexId v);
  void unlink(std::uint32_t corner, VertexId v);
  void give(std::uint32_t corner, VertexId to, StepChanges& changes);
  void kill(FaceId face, StepChanges& changes);

  std::vector<Vec3> positions_;
  std::vector<Triangle> faces_;
  std::vector<std::uint8_t> alive_;
  std::size_t live_faces_;
  /// The corners of a vertex in a ring, in no particular order; first_ is kInvalidId where it has none.
  std::vector<std::uint32_t> first_, next_, previous_;
  std::vector<std::uint32_t> mark_;
  std::uint32_t marks_ = 0;
};

}  // namespace limn
