#pragma once

#include <vector>

#include "limn/hull/intersection_tree.h"
#include "limn/hull/step_guard.h"

namespace limn {

/// Allows no step whose new faces would meet each other or a face that stays, beyond what they share: a surface without
/// self-intersections never gets one, and what others have can only become less. Knows collapses, moves and flips.
class StrictGuard : public StepGuard {
 public:
  /// Cost: n log n, once; then logarithmic for each face a step touches. \pre no face of the surface has died yet
  explicit StrictGuard(const RingSurface& surface);

  bool allows(const RingSurface& surface, const HullStep& step) override;
  void taken(const RingSurface& surface, const HullStep& step) override;

 private:
  void replace_ring(const RingSurface& surface, VertexId vertex, const HullStep& step);

  IntersectionTree tree_;
  std::vector<Corners> new_faces_;
  std::vector<FaceId> old_faces_;
};

}  // namespace limn
