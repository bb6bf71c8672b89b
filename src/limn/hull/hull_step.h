#pragma once

#include <cstdint>

#include "limn/base/vec.h"
#include "limn/mesh/ids.h"

namespace limn {

/// One step from a shell towards its hull. Each moves the surface outwards or leaves it, nowhere inwards: a certificate
/// holds for it on the stored coordinates (docs/hull.md). Vertices and faces keep their ids; steps kill some, and
/// cuts add some.
struct HullStep {
  enum class Kind : std::uint8_t {
    kCollapse,  ///< edge (kept, removed) becomes the one vertex kept, at `after`; two faces die
    kMove,      ///< vertex kept moves to `after`
    /// Edge (kept, removed) becomes edge (left, right): face_left becomes (kept, right, left), face_right (removed,
    /// left, right); no vertex dies or moves.
    kFlip,
    /// The surface parts along the triangle (kept, removed, left), three of its edges but none of its faces: what lies
    /// to their right gets three new vertices at the same places, ids right, right + 1, right + 2, and both sides are
    /// closed by a new face, face_left (kept, left, removed) and face_right == face_left + 1 (right, right + 1, right +
    /// 2), which lie back to back. Ids continue those of the surface: vertex_count and face_count of the shell plus
    /// earlier cuts'.
    kCut,
    /// The part that vertex kept belongs to goes with all its faces: a cavity that fills up. `after` lies outside or in
    /// the plane of each of its faces.
    kFill,
    /// The part that vertex kept belongs to goes with all its faces: it lies where the others' winding number is
    /// positive, so that no point changes from inside to outside. The one kind that lowers a winding number; drops in a
    /// row count as one step: the others are those that are left after the last.
    kDrop,
  };
  Kind kind = Kind::kCollapse;
  VertexId kept = kInvalidId, removed = kInvalidId;  ///< removed: kInvalidId for kMove
  /// The third corners of the faces at the edge: left of the face that runs kept → removed, right of the other.
  VertexId left = kInvalidId, right = kInvalidId;
  FaceId face_left = kInvalidId, face_right = kInvalidId;  ///< those faces; kCollapse kills them, kFlip re-uses them
  Vec3 before{0};                                          ///< where kept was
  Vec3 after{0};                                           ///< where kept is then
};

}  // namespace limn
