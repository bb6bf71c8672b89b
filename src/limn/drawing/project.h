#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "limn/base/camera.h"
#include "limn/drawing/layer.h"
#include "limn/silhouette/lines.h"

namespace limn::drawing {

/// Connected points on a plane. limn's own business, as is all in this namespace.
struct Run {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
  Layer layer = 0;
  bool closed = false;
};

/// Lines on the camera's plane: at distance 1 from the eye for a perspective view, in the mesh's units for a parallel
/// one.
struct PlaneLines {
  std::vector<glm::dvec2> points;
  std::vector<Run> runs;
};

/// Half the width and height of what is kept of the camera's plane.
struct PlaneLimits {
  double half_width;
  double half_height;
};

/// Projects in double, relative to the eye, and cuts at the near plane (perspective only) and the limits.
PlaneLines project(const Polylines& lines, const Camera& camera, const PlaneLimits& limits);

}  // namespace limn::drawing
