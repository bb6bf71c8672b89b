#pragma once

#include <vector>

#include "limn/hull/intersection_tree.h"
#include "limn/hull/shell.h"
#include "limn/hull/step_guard.h"

namespace limn {

/// For inner hulls: allows no step that takes a vertex out of the shell or a face through it. The certificate alone
/// lets part of an inner hull turn inside out and reach through a wall: its winding number is negative there, so that
/// no point inside the hull is outside the mesh, but some of its surface is.
///
/// A vertex starts on the shell and must get to its new place, or from that of the vertex it becomes one with, on a
/// straight way that does not cross it; faces that collapses, moves and cuts make must not pass through it. What others
/// do not touch may still be outside where the shell itself winds backwards.
class InsideGuard : public StepGuard {
 public:
  /// Cost: n log n, once; then logarithmic for each step, and in proportion to the faces near its own.
  explicit InsideGuard(const Shell& shell);

  bool allows(const RingSurface& surface, const HullStep& step) override;
  void taken(const RingSurface&, const HullStep&) override {}

 private:
  void gather(const RingSurface& surface, VertexId vertex, VertexId skip, const Vec3& after);

  IntersectionTree tree_;
  std::vector<Corners> new_faces_;
};

}  // namespace limn
