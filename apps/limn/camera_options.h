#pragma once

#include <optional>

#include "limn/base/camera.h"
#include "limn/mesh/mesh.h"

#include "option_table.h"

namespace limn::cli {

/// Where a mesh is looked at from: --eye, --view, --target, --fov, --ortho.
struct CameraOptions {
  std::optional<Vec3> eye;
  std::optional<Vec2> view_deg;  ///< azimuth, elevation
  std::optional<Vec3> target;
  std::optional<double> fov_deg;
  bool orthographic = false;

  bool placed() const { return eye.has_value() || view_deg.has_value(); }
};

void add_camera_options(OptionTable& table, CameraOptions& options);

/// Errors: kInvalidArgument for options that contradict each other; needs no mesh, so ask first.
Result<void> check_camera(const CameraOptions& options);

/// The camera, its near and far planes around the mesh. Of what was loaded give LoadedMesh::framed(): where a clip
/// asset is drawn that is the original, so that pictures of both line up. \param also what near and far enclose beside
/// it: a hull reaches further than what it was made of. Without --eye and --view it looks from azimuth 30, elevation
/// 20, from as near as the mesh fits. \param aspect width / height \pre the mesh has a face Errors: kInvalidArgument
/// when the eye is at the target.
Result<Camera> place_camera(const CameraOptions& options, const Mesh& mesh, float aspect, const Bounds& also = {});

}  // namespace limn::cli
