#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "limn/base/result.h"
#include "limn/mesh/topology.h"
#include "limn/silhouette/facing.h"

namespace limn::bench {

/// What one view costs, in milliseconds: medians over the views.
struct GpuViewTimes {
  double device_ms = 0;     ///< of the device's work, by its own clock, without read-back
  double wall_ms = 0;       ///< from the call until the list lies on the device
  double read_back_ms = 0;  ///< from the call until the edges' ids are in the caller's memory
};

struct GpuExtractionTimes {
  std::string renderer;    ///< the device
  GpuViewTimes pyramid;    ///< compacted by a histogram pyramid
  GpuViewTimes scan;       ///< compacted by reduce-then-scan
  double upload_ms = 0;    ///< building the extractor, once
  double brute_ms = 0;     ///< extract_silhouette_brute() of the same views, alternated with the device
  double edges_found = 0;  ///< the mean over the views
};

/// Times extraction of a mesh's silhouettes on the graphics device from each eye, by both ways of compaction, with and
/// without read-back, alternated; the first eye is run once more beforehand to warm up.
/// \pre eyes is not empty; planes.size() == topology.face_count()
/// Errors: kNoGraphics where there is no device, it cannot hold the mesh, or limn was built without graphics;
/// kUnsuitable should a view differ from brute force.
Result<GpuExtractionTimes> time_gpu_extraction(const Topology& topology, std::span<const Plane> planes,
                                               std::span<const Eye> eyes);

}  // namespace limn::bench
