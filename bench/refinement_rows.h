#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "refinement_frames.h"

namespace limn::bench {

/// One line of one experiment.
struct RefinementRow {
  std::string experiment;  ///< figure9b, ablations, table3, tessellation, outline
  std::string name;
  std::size_t faces = 0;  ///< of the mesh that is refined
  std::vector<FrameTimes> contestants;
  std::vector<std::pair<std::string, double>> figures{};  ///< what else the row says

  /// nullptr when it did not take part.
  const FrameTimes* find(const std::string& contestant) const;
  /// \pre the row has it
  double figure(const std::string& name) const;
};

struct RefinementBench {
  gl::Context* context = nullptr;
  std::size_t largest = 100'000;
  std::uint64_t seed = 1;
  int size_px = 512;
};

using Rows = Result<std::vector<RefinementRow>>;

/// Dyken et al. 2008, Figure 9b: frame time against the mesh's faces, uniform level 3 or silhouette levels to 3.
Rows figure_9b(const RefinementBench& bench);
/// Their section 7.2: random levels, no blending, packed basis functions.
Rows dyken_ablations(const RefinementBench& bench);
/// Lenz et al. 2009, Table 3: random whole levels that give as many triangles.
Rows table_3(const RefinementBench& bench);
/// Patterns beside the device's tessellation: sparse and dense, geometry alone and with rasterization.
Rows against_tessellation(const RefinementBench& bench);
/// How many triangles uniform refinement takes for the outline that silhouette levels give; no device.
Rows uniform_outline(const RefinementBench& bench);

}  // namespace limn::bench
