#pragma once

#include "limn/base/camera.h"
#include "limn/base/progress.h"
#include "limn/mesh/topology.h"
#include "limn/silhouette/visible/visible_lines.h"

#include "silhouette_options.h"

namespace limn::cli {

/// How many edges of each class, by LineClass.
using EdgeCounts = std::array<std::size_t, kLineClasses.size()>;

/// The lines of a mesh as a camera sees them.
struct FoundLines {
  VisibleLines lines;  ///< of the classes asked for, visible and hidden; no intervals for the outer outline
  EdgeCounts edges{};  ///< of the classes asked for, seen or not
  SilhouetteMethod method = SilhouetteMethod::kBrute;  ///< what found the silhouette
  double prepare_ms = 0;                               ///< planes, and what the method and visibility build once a mesh
  double extract_ms = 0;                               ///< the silhouette edges
  double visible_ms = 0;                               ///< contours and visibility
};

/// Errors: those of the method and of VisibilityScene.
Result<FoundLines> find_lines(const SilhouetteFlags& flags, const Mesh& mesh, const Topology& topology,
                              const Camera& camera, const Progress& progress);

/// The polylines that --visible, --hidden and --all ask for.
Polylines chosen_lines(const SilhouetteFlags& flags, const Polylines& lines);

}  // namespace limn::cli
