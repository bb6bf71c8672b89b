#pragma once

#include <functional>
#include <span>
#include <vector>

#include "limn/base/bounds.h"
#include "limn/hull/triangle_intersection.h"
#include "limn/mesh/ids.h"

namespace limn {

/// The faces of a surface that changes, in a tree of boxes that changes with it: tells which faces a triangle hits.
///
/// Built once over all faces, halved at medians; a face keeps its leaf for life, and its box and those above it follow
/// when it moves, so the tree stays good while faces that are neighbours stay neighbours, as edge collapses leave them.
class IntersectionTree {
 public:
  /// Cost: n log n. Same tree for the same faces. \pre indices in range, coordinates finite
  IntersectionTree(std::span<const Vec3> positions, std::span<const Triangle> faces);

  /// Whether one of these triangles meets a face of the tree that is not ignored, or another one of them, beyond shared
  /// corners and sides (intersect_beyond_shared). Exact.
  /// Cost: logarithmic in the faces, and in proportion to those whose boxes meet the triangles'.
  bool hits(std::span<const Corners> triangles, std::span<const FaceId> ignored) const;

  /// Calls visit for each face of a higher id that meets this one beyond shared corners and sides, in no particular
  /// order.
  void for_each_hit_above(FaceId face, const std::function<void(FaceId)>& visit) const;

  /// Whether the way from p straight to q passes through a face from one side to the other. A face whose plane p lies
  /// in is not crossed, nor one that q lies on. Exact.
  bool crosses(const Vec3& p, const Vec3& q) const;

  /// Takes a face out. Removing it again changes nothing. Cost: logarithmic.
  void remove(FaceId face);
  /// Puts a face where its corners are now; one that was taken out is back in. Cost: logarithmic.
  void update(FaceId face, const Corners& corners);

  /// Where a face is. Meaningless once it is removed.
  const Corners& corners(FaceId face) const { return corners_[face]; }

 private:
  template <class Visit>
  bool visit_boxes(const Bounds& box, Visit visit) const;
  void refit(FaceId face, const Bounds& box);

  std::vector<Corners> corners_;
  std::vector<std::uint32_t> leaf_of_;  ///< one a face: its node
  std::vector<FaceId> face_at_;         ///< one a leaf, from leaf_begin_ on
  std::vector<Bounds> boxes_;           ///< a heap: node i has 2i and 2i + 1 below it, 1 is the root
  std::uint32_t leaf_begin_ = 1;
};

}  // namespace limn
