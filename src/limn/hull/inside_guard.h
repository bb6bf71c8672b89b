#pragma once

#include "limn/hull/intersection_tree.h"
#include "limn/hull/shell.h"
#include "limn/hull/step_guard.h"

namespace limn {

/// For inner hulls: allows no step that takes a vertex out of the shell. The certificate alone
/// lets part of an inner hull turn inside out and reach through a wall: its winding number is negative there, so that
/// no point inside the hull is outside the mesh, but vertices are.
///
/// A vertex starts on the shell and must get to its new place, or from that of the vertex it becomes one with,
/// on a straight way that does not cross it.
class InsideGuard : public StepGuard {
 public:
  /// Cost: n log n, once; then logarithmic for each step, and in proportion to the faces near its way.
  explicit InsideGuard(const Shell& shell);

  bool allows(const RingSurface& surface, const HullStep& step) override;
  void taken(const RingSurface&, const HullStep&) override {}

 private:
  IntersectionTree tree_;
};

}  // namespace limn
