#pragma once

#include <cstddef>
#include <vector>

#include "limn/hull/cost_queue.h"
#include "limn/hull/placement.h"
#include "limn/hull/ring_surface.h"

namespace limn {

struct CollapseCounts {
  std::size_t programs = 0, infeasible = 0, stale = 0, popped = 0, topology = 0, folds = 0, refused = 0, cuts = 0, vanished = 0, flips = 0, pockets = 0, filled = 0, bumps = 0;
  std::size_t certified = 0;
  double worst_margin = 1e300;
};

/// Collapses edges of a surface, cheapest first, each to where it adds the least volume, and proves each.
class Collapser {
 public:
  explicit Collapser(RingSurface& surface);
  void fill();
  /// One collapse. \return false when no candidate is left
  bool step(HullStep& done);
  std::size_t rescue(double share, std::vector<HullStep>& done);
  void diagnose();
  const CollapseCounts& counts() const { return counts_; }

 private:
  bool evaluate(VertexId a, VertexId b, Candidate& candidate);
  void offer(VertexId a, VertexId b);
  bool certify(VertexId v, VertexId skip, const Vec3& position, double& margin);
  bool folds(VertexId v, VertexId skip, const Vec3& position);
  double scale3() const { return surface_.scale() * surface_.scale() * surface_.scale(); }
  bool try_cut(VertexId a, VertexId b);
  bool parts(VertexId a, VertexId b, VertexId c, std::vector<VertexId>* small = nullptr, int* which = nullptr);
  double part_volume(const std::vector<VertexId>& v);
  void resolve(std::vector<VertexId> part);
  std::vector<VertexId> part_of(VertexId v);
  HullStep do_cut(VertexId a, VertexId b, VertexId c);
  bool fill_pocket(const std::vector<VertexId>& part);
  bool attempt(const Candidate& candidate, HullStep& done);

  RingSurface& surface_;
  CostQueue queue_;
  PlacementPlanes planes_;
  std::vector<double> weights_, base_;
  std::vector<std::uint32_t> born_, touched_;
  CollapseCounts counts_;
};

}  // namespace limn
