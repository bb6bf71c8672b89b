#pragma once

#include <span>

#include "limn/mesh/mesh.h"
#include "limn/silhouette/facing.h"

namespace limn {

/// The frame in which clusters of faces are culled, and what faces_eye() may be wrong by in it.
///
/// The mesh is moved to the origin and scaled to the unit sphere, in double, so that bounds neither overflow nor
/// underflow. Within it faces_eye(plane, eye) equals the sign of the plane's exact value at the eye wherever that value
/// exceeds plane_error + kEyeError·|eye|; a bound that keeps this distance culls nothing that faces_eye() would find.
struct CullingFrame {
  DVec3 center{0.0};
  double per_unit = 1.0;     ///< 1 / radius of the mesh
  double plane_error = 0.0;  ///< of a plane's float value at any eye, without the share that grows with the eye
  static constexpr double kEyeError = 3e-7;  ///< four float roundings, and a quarter more
};

/// The frame of a mesh. \pre planes is face_planes(mesh)
CullingFrame culling_frame(const Mesh& mesh, std::span<const Plane> planes);

/// The plane n·x + d = 0 of a face in the frame, in double with a unit normal.
struct FramedPlane {
  DVec3 normal{0.0};
  double offset = 0.0;
  bool usable = false;  ///< false for faces without area and planes that overflowed: their clusters are never culled
};
FramedPlane framed_plane(const Plane& plane, const CullingFrame& frame);

/// An eye in the frame.
struct FramedEye {
  DVec3 at{0.0};          ///< the point; or a unit direction towards the viewer
  double is_point = 1.0;  ///< 0 when orthographic
  bool cullable = true;   ///< false where faces_eye() overflows or underflows: then every edge must be tested
};
FramedEye framed_eye(const Eye& eye, const CullingFrame& frame);

}  // namespace limn
