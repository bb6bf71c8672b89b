#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "limn/hull/certificate.h"
#include "limn/hull/cost_queue.h"
#include "limn/hull/placement.h"
#include "limn/hull/ring_surface.h"
#include "limn/hull/step_guard.h"

namespace limn {

/// What became of the edges that were looked at.
struct CollapseCounts {
  std::size_t programs = 0;    ///< placements computed
  std::size_t infeasible = 0;  ///< no place outside of all planes, or too far away
  std::size_t linked = 0;      ///< collapses that the link condition refused
  std::size_t folded = 0;      ///< that would have turned a face over
  std::size_t refused = 0;     ///< that the exact test refused
  std::size_t guarded = 0;     ///< that the guard refused
};

/// Collapses edges of a surface, cheapest first, each to where it adds the least volume, and proves each.
///
/// Costs wait in a queue. A collapse makes those of the new vertex's edges anew; edges two rings out find out when
/// they are popped that a face of theirs has moved, and are placed again then.
class Collapser {
 public:
  /// All must outlive it; `guard` may be nullptr. Steps taken are added to `log`.
  Collapser(RingSurface& surface, std::vector<HullStep>& log, Certificate& certificate, StepGuard* guard);

  /// Places every edge anew. Costs are computed on all threads; the queue is the same for any number of them.
  void offer_all();
  /// Places every edge at some vertices anew: their surroundings have changed.
  void offer_around(std::span<const VertexId> vertices);
  /// How far from the edge's middle the vertex may go, in lengths of the edge.
  void set_reach(double reach) { reach_ = reach; }

  enum class Outcome : std::uint8_t {
    kCollapsed,
    kLinked,     ///< nothing changed: the edge is one of a triangle that is no face; see edge()
    kExhausted,  ///< no candidate is left
  };
  Outcome step();
  /// The edge that step() ended with.
  const Candidate& edge() const { return edge_; }
  const CollapseCounts& counts() const { return counts_; }

 private:
  /// What placing one edge needs, so that threads can place edges at once.
  struct Workspace {
    PlacementPlanes planes;
    std::vector<FaceId> faces;
  };

  bool place(VertexId a, VertexId b, Workspace& workspace, Candidate& candidate) const;
  std::size_t gather(VertexId a, VertexId b, std::vector<FaceId>& faces) const;
  void offer(VertexId a, VertexId b);
  bool refresh(Candidate& candidate);
  bool folds(VertexId v, VertexId skip, const Vec3& position) const;
  bool take(const Candidate& candidate);

  RingSurface& surface_;
  std::vector<HullStep>& log_;
  Certificate& certificate_;
  StepGuard* guard_;
  CostQueue queue_;
  Workspace workspace_;
  std::vector<std::uint32_t> born_;     ///< how often all edges of a vertex were placed anew
  std::vector<std::uint32_t> touched_;  ///< how often a face around a vertex changed
  Candidate edge_{};
  CollapseCounts counts_;
  double reach_ = 10.0;
};

}  // namespace limn
