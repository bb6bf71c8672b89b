#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "limn/base/result.h"
#include "limn/mesh/mesh.h"
#include "limn/silhouette/sander/paper_forest.h"

#include "plot.h"

namespace limn::bench {

/// Viewpoints uniform over spheres about the mesh, `views` on each.
struct SanderOptions {
  int views = 100;
  std::vector<double> radii = {1.2, 3.0, 10.0};  ///< in radii of the mesh: half the diagonal of its box
  std::uint64_t seed = 1;
  PaperForestOptions forest;
};

/// What one way of searching tested, and its time: means over the views, and the median.
struct SearchMeasured {
  double edges = 0;
  double nodes = 0;
  double us = 0;
  double edge_equivalents() const { return edges + 4.0 / 3.0 * nodes; }
};

/// A column of Sander et al. 2000, table 2, or a point of figure 9.
struct SanderRow {
  std::string name;
  std::size_t faces = 0;
  std::size_t edges = 0;
  std::size_t forest_nodes = 0;
  std::size_t roots = 0;
  double build_s = 0;
  double silhouette_edges = 0;  ///< the mean over the views
  SearchMeasured forest;
  SearchMeasured johannsen_carter;            ///< the same forest with half-spaces in place of anchored cones
  double brute_us = 0;                        ///< extract_silhouette_brute(), the median
  std::vector<double> equivalents_by_radius;  ///< of the forest, beside SanderOptions::radii
  std::size_t mismatches = 0;                 ///< views in which a search and brute force differ: must be 0
};

/// Builds the forest and searches it from every viewpoint; each contestant in turn for each, all on one thread.
Result<SanderRow> measure_sander(const std::string& name, const Mesh& mesh, const SanderOptions& options);

/// The rows of figure 9: the mesh reduced to 500, 4,000, 20,000 and 50,000 faces, and itself.
Result<std::vector<SanderRow>> measure_figure9(const std::string& name, const Mesh& mesh, const SanderOptions& options);

/// Figure 9's rows of the bunny, then table 2's: shapes and models like the paper's at its sizes. What is not in the
/// folder is left out. Errors: as read_mesh and make_shape.
Result<std::vector<SanderRow>> measure_table2(const std::filesystem::path& models, const SanderOptions& options);

/// Table 2 as text: one line a row.
std::string sander_table(const std::vector<SanderRow>& rows);

/// Figure 9: time against silhouette edges, of brute force and of the forest.
Plot sander_plot(const std::vector<SanderRow>& rows);

}  // namespace limn::bench
