#include "limn/hull/inside_guard.h"

namespace limn {

InsideGuard::InsideGuard(const Shell& shell) : tree_(shell.positions, shell.faces) {}

bool InsideGuard::allows(const RingSurface& surface, const HullStep& step) {
  if (step.kind != HullStep::Kind::kCollapse && step.kind != HullStep::Kind::kMove) return true;
  if (!tree_.crosses(step.before, step.after)) return true;
  return step.kind == HullStep::Kind::kCollapse && !tree_.crosses(surface.position(step.removed), step.after);
}

}  // namespace limn
