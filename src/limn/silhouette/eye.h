#pragma once

#include "limn/base/camera.h"
#include "limn/base/vec.h"

namespace limn {

/// Where a mesh is seen from, in the mesh's own space: a point, or for a parallel projection the direction towards the
/// viewer.
struct Eye {
  Vec3 at{0, 0, 1};  ///< the point; or, when orthographic, the direction (any length but 0)
  bool orthographic = false;
};

/// The eye of a camera.
Eye eye_of(const Camera& camera);

/// An eye and how large things appear from it: what levels by pixels need.
struct View {
  Eye eye{};
  /// Pixels that one unit of length covers: across the line of sight at distance 1 (perspective; divide by the
  /// distance), or anywhere (orthographic). 0: unknown.
  float pixels_per_unit = 0.0f;
};

/// The view of a camera whose picture is `height_px` high.
View view_of(const Camera& camera, int height_px);

}  // namespace limn
