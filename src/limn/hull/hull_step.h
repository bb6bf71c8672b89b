#pragma once

#include "limn/base/vec.h"
#include "limn/mesh/ids.h"

namespace limn {

/// One step from a shell towards its hull. Each moves the surface outwards or leaves it, nowhere inwards: a certificate
/// holds for it on the stored coordinates (docs/hull.md). Vertices and faces keep their ids; steps only kill some.
struct HullStep {
  enum class Kind : std::uint8_t {
    kCollapse,  ///< edge (kept, removed) becomes the one vertex kept, at `after`; two faces die
    kMove,      ///< vertex kept moves to `after`
    /// Edge (kept, removed) becomes edge (left, right): face_left becomes (kept, right, left), face_right (removed, left,
    /// right); no vertex dies or moves.
    kFlip,
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
