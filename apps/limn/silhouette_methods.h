#pragma once

#include <initializer_list>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "limn/base/progress.h"
#include "limn/base/result.h"
#include "limn/mesh/topology.h"
#include "limn/silhouette/facing.h"

namespace limn::cli {

/// How silhouette edges are found; all find the same.
enum class SilhouetteMethod {
  kAuto,         ///< what is fastest for one view, everything counted: kBrute, which needs nothing built
  kBrute,        ///< test every edge
  kForest,       ///< down a search tree
  kPaperForest,  ///< the search forest of Sander et al. 2000
  kGpu,          ///< on the graphics device
};

/// Those that this program was built with, and their names.
std::span<const std::pair<std::string_view, SilhouetteMethod>> silhouette_methods();
std::string_view method_name(SilhouetteMethod method);

/// The silhouette edges, ascending, and what finding them took.
struct FoundSilhouette {
  std::vector<EdgeId> edges;
  SilhouetteMethod method = SilhouetteMethod::kBrute;  ///< never kAuto
  double build_ms = 0;                                 ///< what the method makes once a mesh
  double extract_ms = 0;                               ///< the search from this eye
};

/// Errors: kNoGraphics, kCancelled.
Result<FoundSilhouette> find_silhouette(SilhouetteMethod method, const Mesh& mesh, const Topology& topology,
                                        std::span<const Plane> planes, const Eye& eye, const Progress& progress);

}  // namespace limn::cli
