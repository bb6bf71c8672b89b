#pragma once

#include <optional>
#include <string>
#include <vector>

#include "limn/mesh/mesh.h"

namespace limn::bench {

struct ExtractionOptions {
  int views = 60;                                ///< a third at each radius
  std::vector<double> radii = {1.5, 3.0, 10.0};  ///< of the viewpoints' spheres, in radii of the mesh
  std::uint64_t seed = 1;
  int repeats =
      3;  ///< runs of each contestant in its turn, of which the fastest counts: the mesh is then as near as it gets
  int threads = 1;
  bool vtk = true;
  bool gpu = false;
};

/// Times of one contestant over the views, in microseconds.
struct ContestantTimes {
  std::string name;
  double median_us = 0;
  double low_us = 0, high_us = 0;  ///< quartiles
};

/// A mesh of Dyken et al. 2008, figure 9a, with everything that may be picked today.
struct ExtractionRow {
  std::string name;
  std::size_t faces = 0;
  std::size_t edges = 0;
  double silhouette_share = 0;  ///< of the edges, mean over the views
  double leaves_entered = 0;    ///< share, mean over the views
  std::vector<ContestantTimes> contestants;
  std::size_t mismatches = 0;  ///< views in which a contestant of limn found another set than the oracle: must be 0
  double swept_bytes = 0;      ///< an edge, by the brute force over quantized planes
  double exact_bytes = 0;      ///< over floats
  double floor_ns = 0;         ///< an edge: the time memory takes for swept_bytes
  double exact_floor_ns = 0;
  double read_gb_s = 0;        ///< measured over a buffer of the swept size, in this run
  double build_s = 0;          ///< clusters and tree, given topology and planes
  double tree_bytes = 0;       ///< an edge
  double vtk_lines_ratio = 0;  ///< VTK's lines over limn's, for a check that both do the same

  /// Median of a contestant, if it ran.
  std::optional<double> median_us(const std::string& name) const;
};

/// Every contestant takes its turn in every view.
ExtractionRow measure_extraction(const std::string& name, const Mesh& mesh, const ExtractionOptions& options);

/// A sheet of unrelated heights: nearly every part of it has silhouettes from everywhere, so that no tree helps.
Mesh rough_adversary(std::size_t faces, std::uint64_t seed);

}  // namespace limn::bench
