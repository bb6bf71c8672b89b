#pragma once

#include <vector>

#include "limn/hull/intersection_tree.h"
#include "limn/hull/shell.h"
#include "limn/hull/step_guard.h"

namespace limn {

/// Allows a collapse when none of its new faces meets another face, beyond corners and sides that they share: a surface
/// that does not cross or touch itself then never will. Exact. Other steps it does not know, and refuses.
/// Cost: a search of a tree of boxes a collapse.
class StrictGuard : public StepGuard {
 public:
  explicit StrictGuard(const Shell& shell) : tree_(shell.positions, shell.faces) {}

  bool allows(const RingSurface& surface, const HullStep& step) override;
  void taken(const RingSurface& surface, const HullStep& step) override;

 private:
  void gather(const RingSurface& surface, VertexId v, VertexId skip, const Vec3& after);

  IntersectionTree tree_;
  std::vector<Corners> triangles_;
  std::vector<FaceId> replaced_;
};

}  // namespace limn
