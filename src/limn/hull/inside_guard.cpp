#include "limn/hull/inside_guard.h"

#include <algorithm>

namespace limn {

InsideGuard::InsideGuard(const Shell& shell) : tree_(shell.positions, shell.faces) {}

/// The faces around a vertex with the vertex in its new place, but for those at `skip`, which die.
void InsideGuard::gather(const RingSurface& surface, VertexId vertex, VertexId skip, const Vec3& after) {
  const std::span<const RingLink> ring = surface.ring(vertex);
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const VertexId here = ring[i].vertex, next = ring[(i + 1) % ring.size()].vertex;
    if (here != skip && next != skip) new_faces_.push_back({after, surface.position(here), surface.position(next)});
  }
}

bool InsideGuard::allows(const RingSurface& surface, const HullStep& step) {
  if (step.kind == HullStep::Kind::kCut) {
    return !tree_.pierces({surface.position(step.kept), surface.position(step.removed), surface.position(step.left)});
  }
  const bool collapses = step.kind == HullStep::Kind::kCollapse;
  if (!collapses && step.kind != HullStep::Kind::kMove) return true;
  if (tree_.crosses(step.before, step.after)) {
    if (!collapses || tree_.crosses(surface.position(step.removed), step.after)) return false;
  }
  new_faces_.clear();
  gather(surface, step.kept, step.removed, step.after);
  if (collapses) gather(surface, step.removed, step.kept, step.after);
  return std::none_of(new_faces_.begin(), new_faces_.end(), [&](const Corners& face) { return tree_.pierces(face); });
}

}  // namespace limn
