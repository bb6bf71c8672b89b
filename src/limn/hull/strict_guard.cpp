#include "limn/hull/strict_guard.h"

namespace limn {
namespace {

IntersectionTree tree_of(const RingSurface& surface) {
  std::vector<FaceId> ids;
  const std::vector<Triangle> faces = surface.faces(ids);
  return {surface.positions(), faces};
}

}  // namespace

StrictGuard::StrictGuard(const RingSurface& surface) : tree_(tree_of(surface)) {}

/// The faces around a vertex of the step go; but for those that die, each comes back with the vertex in its new place.
void StrictGuard::replace_ring(const RingSurface& surface, VertexId vertex, const HullStep& step) {
  const std::span<const RingLink> ring = surface.ring(vertex);
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const FaceId face = ring[i].face;
    const bool dies = step.kind == HullStep::Kind::kCollapse && (face == step.face_left || face == step.face_right);
    if (dies && vertex == step.removed) continue;  // met from the other end
    old_faces_.push_back(face);
    if (dies) continue;
    const VertexId next = ring[(i + 1) % ring.size()].vertex;
    new_faces_.push_back({step.after, surface.position(ring[i].vertex), surface.position(next)});
  }
}

bool StrictGuard::allows(const RingSurface& surface, const HullStep& step) {
  new_faces_.clear();
  old_faces_.clear();
  switch (step.kind) {
    case HullStep::Kind::kCollapse:
      replace_ring(surface, step.kept, step);
      replace_ring(surface, step.removed, step);
      break;
    case HullStep::Kind::kMove:
      replace_ring(surface, step.kept, step);
      break;
    case HullStep::Kind::kFlip: {
      const Vec3 &kept = surface.position(step.kept), &removed = surface.position(step.removed);
      const Vec3 &left = surface.position(step.left), &right = surface.position(step.right);
      old_faces_ = {step.face_left, step.face_right};
      new_faces_ = {Corners{kept, right, left}, Corners{removed, left, right}};
      break;
    }
    case HullStep::Kind::kCut:
      return false;  // its two new faces lie on each other
    case HullStep::Kind::kFill:
    case HullStep::Kind::kDrop:
      return true;
  }
  return !tree_.hits(new_faces_, old_faces_);
}

void StrictGuard::taken(const RingSurface& surface, const HullStep& step) {
  const auto update_around = [&](VertexId v) {
    const std::span<const RingLink> ring = surface.ring(v);
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const VertexId next = ring[(i + 1) % ring.size()].vertex;
      tree_.update(ring[i].face, {surface.position(v), surface.position(ring[i].vertex), surface.position(next)});
    }
  };
  if (step.kind == HullStep::Kind::kCollapse) {
    tree_.remove(step.face_left);
    tree_.remove(step.face_right);
  }
  if (step.kind == HullStep::Kind::kFlip) update_around(step.left);
  if (step.kind == HullStep::Kind::kCollapse || step.kind == HullStep::Kind::kMove) update_around(step.kept);
}

}  // namespace limn
