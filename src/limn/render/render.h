#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "limn/base/camera.h"
#include "limn/base/result.h"
#include "limn/gl/context.h"
#include "limn/image/image.h"
#include "limn/mesh/mesh.h"

namespace limn {

/// A line drawn over the picture: two points and a colour (sRGB 0 … 1).
struct Segment3 {
  Vec3 a, b;
  Vec3 color;
};

struct RenderOptions {
  int width = 1024;
  int height = 1024;
  int samples = 4;  ///< 1 or 4
  /// sRGB 0 … 1 with alpha; alpha 0 leaves coverage in the picture's alpha.
  Vec4 background{1, 1, 1, 1};
  bool wireframe = false;  ///< thin lines over the shaded faces, hidden ones removed
  bool flat = false;       ///< face normals instead of the mesh's
  bool draw_faces = true;
  float line_width_px = 1.5f;  ///< of `segments`
};

/// Draws a lit picture of a mesh: a head light, a sky, base colours and base colour textures.
///
/// \param segments  drawn over it where not hidden by it (a small depth bias in their favour), for outlines and levels
/// Mesh normals are used where there are some, else face normals; both sides are lit. An empty mesh gives the
/// background. Errors: kInvalidArgument (sizes outside 1 … 16384, samples), kNoGraphics when the device cannot hold the
/// picture.
Result<Image> render(gl::Context& context, const Mesh& mesh, const Camera& camera, const RenderOptions& options = {},
                     std::span<const Segment3> segments = {});

/// A colour for a level in [0, max_level]: dark blue at 0 through green to yellow (the same in docs and legends).
Vec3 level_color(float level, float max_level);

}  // namespace limn
