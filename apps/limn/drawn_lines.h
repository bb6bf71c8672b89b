#pragma once

#include <optional>
#include <vector>

#include "limn/base/camera.h"
#include "limn/refine/refine.h"
#include "limn/render/render.h"

namespace limn::cli {

/// Appends the silhouette of a mesh as a camera sees it, and its boundary edges.
void append_outline(const Mesh& mesh, const Camera& camera, const Vec3& color, std::vector<Segment3>& lines);

/// Appends every edge of the unrefined mesh, coloured by its level.
/// \param blend  along the surface refined with it; none: straight
void append_level_lines(const Refiner& refiner, const Refinement& refined, int max_level, std::optional<Blend> blend,
                        std::vector<Segment3>& lines);

}  // namespace limn::cli
