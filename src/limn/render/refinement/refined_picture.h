#pragma once

#include <cstdint>

#include "limn/render/refinement/method.h"
#include "limn/render/render.h"

namespace limn {

/// A picture, and what it took.
struct RefinedPicture {
  Image image;
  std::uint64_t triangles = 0;
  double refine_ms = 0;  ///< RefinementMethod::refine(), until the device was done
  double draw_ms = 0;    ///< RefinementMethod::draw() likewise, the first use of its programs included
};

/// Draws a scene by a method, refined for the camera, with the lights and the meaning of pixels of render().
///
/// draw_faces and line_width_px are not looked at. The materials are those of the scene's meshes. Leaves the context
/// current and its GL state changed. \pre the method is the scene's; the scene is near unit size (unit_scale(),
/// render/picture.h); camera.eye != camera.target. Errors: those of render(), and of the method.
Result<RefinedPicture> render_refined(const RefinementScene& scene, RefinementMethod& method, const Camera& camera,
                                      const RenderOptions& options = {});

}  // namespace limn
