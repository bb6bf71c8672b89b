#include "limn/hull/strict_guard.h"

namespace limn {

/// What the faces around v become when it goes elsewhere; those at `skip` vanish.
void StrictGuard::gather(const RingSurface& surface, VertexId v, VertexId skip, const Vec3& after) {
  const std::span<const RingLink> ring = surface.ring(v);
  RingLink last = ring.back();
  for (const RingLink& link : ring) {
    replaced_.push_back(last.face);
    if (last.vertex != skip && link.vertex != skip)
      triangles_.push_back({after, surface.position(last.vertex), surface.position(link.vertex)});
    last = link;
  }
}

bool StrictGuard::allows(const RingSurface& surface, const HullStep& step) {
  if (step.kind != HullStep::Kind::kCollapse) return false;
  triangles_.clear();
  replaced_.clear();
  gather(surface, step.kept, step.removed, step.after);
  gather(surface, step.removed, step.kept, step.after);
  return !tree_.hits(triangles_, replaced_);
}

void StrictGuard::taken(const RingSurface& surface, const HullStep& step) {
  tree_.remove(step.face_left);
  tree_.remove(step.face_right);
  const std::span<const RingLink> ring = surface.ring(step.kept);
  RingLink last = ring.back();
  for (const RingLink& link : ring) {
    tree_.update(last.face,
                 {surface.position(step.kept), surface.position(last.vertex), surface.position(link.vertex)});
    last = link;
  }
}

}  // namespace limn
