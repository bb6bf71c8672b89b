#pragma once

#include <span>

#include "limn/base/bounds.h"
#include "limn/base/vec.h"

namespace limn {

/// A viewpoint and its projection. Right-handed, y up; looks from `eye` towards `target`.
struct Camera {
  Vec3 eye{0, 0, 3};
  Vec3 target{0, 0, 0};
  Vec3 up{0, 1, 0};
  bool orthographic = false;
  float fov_rad = 0.6f;        ///< vertical opening angle; perspective only
  float ortho_height = 2.0f;   ///< height of the picture in the model's units; orthographic only
  float near_distance = 0.1f;  ///< > 0
  float far_distance = 100.0f;
};

/// World to eye space. When `up` is parallel to the view direction another axis takes its place. \pre eye != target
Mat4 view_matrix(const Camera& camera);

/// Eye space to OpenGL clip space (z from -1 to 1). \param aspect width / height, > 0
Mat4 projection_matrix(const Camera& camera, float aspect);

/// How fit_camera frames a box.
struct CameraFit {
  bool orthographic = false;
  float fov_rad = 0.6f;
  float fill = 0.9f;    ///< share of the picture's smaller side that the box's diagonal spans
  float aspect = 1.0f;  ///< width / height
};

/// A camera that looks at the middle of `bounds` from azimuth (0 looks from +z, turning towards +x) and elevation
/// (towards +y), so that the sphere around the box fills `fill` of the smaller side; near and far enclose that sphere.
/// A box of size 0 is treated as one of diagonal 1. \pre !bounds.empty()
Camera fit_camera(const Bounds& bounds, float azimuth_rad, float elevation_rad, const CameraFit& fit = {});

/// As above, from a direction towards the viewer. \pre direction is of unit length
Camera fit_camera(const Bounds& bounds, const Vec3& direction, const CameraFit& fit = {});

/// As above, but as near as the points themselves allow: their picture spans `fill` of the width or of the height and
/// no more of the other, and lies in the middle of it. `target` is the middle of what is seen; near and far enclose the
/// points. Cost: two passes over the points. \pre there is a point; all are finite
Camera fit_camera(std::span<const Vec3> points, const Vec3& direction, const CameraFit& fit = {});

/// The unit direction towards a viewer at this azimuth and elevation, as fit_camera takes them.
Vec3 view_direction(float azimuth_rad, float elevation_rad);

}  // namespace limn
