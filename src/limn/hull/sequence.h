#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "limn/base/result.h"
#include "limn/hull/hull_step.h"
#include "limn/hull/shell.h"
#include "limn/mesh/mesh.h"

namespace limn {

/// A shell and the ways that lead from it outwards and inwards, one step a level: the nested sequence
///   coarsest inner hull … shell … coarsest outer hull
/// each member of which encloses those before it (Sander et al. 2000, section 3). Level 0 is the shell itself, level
/// i > 0 what the first i outer steps make of it, level -i what the first i inner ones do.
///
/// Every member is a closed manifold over the shell's vertex and face ids, and further ones where steps cut the
/// surface. That is checked when a sequence is made; that the steps move outwards or inwards is not: it is what their
/// maker proves (progressive_hull.h).
class HullSequence {
 public:
  /// \param outer, inner  as build_hull() gives them with keep_steps; may be empty
  /// \param uvs           one a vertex of the shell, or none
  /// Cost: linear. Same bits for any number of threads.
  /// Errors: kInvalidArgument, naming the step, where one does not fit the surface that those before it made, or where
  /// the shell is no closed manifold or a uv is missing or not finite.
  static Result<HullSequence> make(Shell shell, std::vector<HullStep> outer, std::vector<HullStep> inner = {},
                                   std::vector<Vec2> uvs = {});

  /// What level 0 is. Read from a file, it has neither sources nor notes.
  const Shell& shell() const { return shell_; }
  std::span<const HullStep> outer_steps() const { return outer_.steps; }
  std::span<const HullStep> inner_steps() const { return inner_.steps; }
  std::span<const Vec2> uvs() const { return uvs_; }

  int innermost() const { return -static_cast<int>(inner_.steps.size()); }
  int outermost() const { return static_cast<int>(outer_.steps.size()); }

  /// \pre innermost() <= level <= outermost()
  std::size_t faces_at(int level) const;
  /// The level nearest to the shell, outwards or inwards, that has no more faces than this; the last one where none
  /// has.
  int outer_level(std::size_t faces) const;
  int inner_level(std::size_t faces) const;

  /// A member as a mesh, its vertices and faces in ascending order of their ids. Normals are smooth, of its own faces;
  /// uvs, where the sequence has any, those of the vertices that stayed.
  /// \param vertex_ids, face_ids  get the ids of its vertices and faces, the shell's where they are below its counts,
  /// else of what cuts made on the way; may be nullptr Same bits whichever way the level was come to. Cost: linear in
  /// the shell and the steps from it. \pre innermost() <= level <= outermost()
  Mesh mesh_at(int level, std::vector<VertexId>* vertex_ids = nullptr, std::vector<FaceId>* face_ids = nullptr) const;

  /// One a vertex of the shell: the vertex of the member (by its id) that it became part of; kInvalidId where it was of
  /// a part that vanished. Where a cut doubled a vertex, the one that kept the id.
  /// \pre innermost() <= level <= outermost()
  std::vector<VertexId> heirs_at(int level) const;

 private:
  friend class HullCursor;
  /// A corner (3 * face + c) that a step gives to another vertex.
  struct CornerChange {
    std::uint32_t corner;
    VertexId from, to;
  };
  /// One way from the shell. Offsets are one more than steps.
  struct Way {
    std::vector<HullStep> steps;
    std::vector<std::uint32_t> faces{};   ///< one more than steps: faces after so many
    std::vector<std::uint32_t> fewest{};  ///< the fewest so far, of levels that are hulls
    std::vector<std::uint32_t> corner_offsets{};
    std::vector<CornerChange> corners{};
    std::vector<std::uint32_t> killed_offsets{};
    std::vector<FaceId> killed{};
    std::vector<std::uint32_t> vanished_offsets{};
    std::vector<VertexId> vanished{};
    std::size_t cuts = 0;
  };
  static Result<void> go(const Shell& shell, bool inwards, Way& way);

  HullSequence() = default;

  Shell shell_;
  Way outer_, inner_;
  std::vector<Vec2> uvs_;
};

/// Texture coordinates for the vertices of a mesh's shell: where all faces of each agree, as they do without seams;
/// none where two disagree, or where closing added a vertex.
std::vector<Vec2> shell_uvs(const Mesh& mesh, const Shell& shell);

/// A place in a sequence that moves a step at a time, both ways, in time proportional to the faces a step touches.
/// The sequence must outlive it.
class HullCursor {
 public:
  explicit HullCursor(const HullSequence& sequence);

  int level() const { return level_; }
  std::size_t face_count() const { return live_faces_; }

  /// One step towards the outermost or the innermost member; false, and nothing happens, at the end.
  bool step_outwards();
  bool step_inwards();
  /// \pre innermost() <= level <= outermost()
  void go_to(int level);

  /// By their ids. What is said of vertices and faces that are not there is of no account.
  std::span<const Vec3> positions() const { return positions_; }
  std::span<const Triangle> faces() const { return faces_; }
  bool is_alive(FaceId face) const { return alive_[face] != 0; }

 private:
  void take(const HullSequence::Way& way, bool inwards, std::size_t number);
  void take_back(const HullSequence::Way& way, std::size_t number);
  void set_alive(FaceId face, bool alive);

  const HullSequence* sequence_;
  int level_ = 0;
  std::size_t live_faces_;
  std::vector<Vec3> positions_;
  std::vector<Triangle> faces_;
  std::vector<std::uint8_t> alive_;
};

}  // namespace limn
