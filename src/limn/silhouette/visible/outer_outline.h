#pragma once

#include <span>

#include "limn/silhouette/facing.h"
#include "limn/silhouette/lines.h"
#include "limn/silhouette/visible/visibility.h"

namespace limn {

/// The outer outline alone: the parts of silhouettes, boundaries and non-manifold edges past which the background is
/// seen, joined into loops that keep the mesh on their left in the picture.
///
/// Where one contour passes in front of another the outline goes over from one to the other: in space the polyline then
/// has a segment along the line of sight (Polylines::edges is kInvalidId there), in the picture both points are one.
/// Every polyline is visible and outer; its class is that of its longest run of one class, the earlier in a tie. Closed
/// unless ends farther apart than 1e-4 of the picture remain (eyes inside the mesh's box, lines seen end-on).
///
/// \param silhouette  all silhouette edges from this eye, in any order
/// \pre planes is face_planes() of the scene's mesh
/// Same bits for any number of threads. Cost: find_visibility's with `outer`. docs/visibility.md
Polylines outer_outline(const VisibilityScene& scene, std::span<const Plane> planes, const Eye& eye,
                        std::span<const EdgeId> silhouette, VisibilityReport* report = nullptr);

}  // namespace limn
