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
  bool wireframe = false;      ///< lines of a pixel over the shaded faces, hidden ones removed
  bool flat = false;           ///< face normals instead of the mesh's
  bool draw_faces = true;      ///< false: faces leave no colour, but hide the lines behind them all the same
  float line_width_px = 1.5f;  ///< of `segments`, > 0
};

/// Draws a lit picture of a mesh: a head light, a sky, base colours and their pictures, normal maps.
///
/// \param segments  drawn over it where not hidden by it (a small depth bias in their favour), for outlines and levels
/// Mesh normals are used where there are some, else face normals; both sides are lit. Vertex colours multiply the base
/// colour; surfaces are opaque whatever their alpha. An empty mesh gives the background, and the segments. Wireframe
/// lines fade where triangles are smaller than a few pixels. A mesh without materials is drawn in a light clay colour.
/// Same device and driver, same bits. Leaves the context current and its GL state changed.
/// \pre indices in range, counts consistent (read_mesh sees to that); camera.eye != camera.target
/// Cost: memory on the device for the mesh (one value a vertex; three times the faces where corners have indices of
/// their own), its materials' pictures (docs/rendering.md says how sizes are matched) and 8 bytes a sample; programs
/// are compiled on first use of a context. Errors: kInvalidArgument (sizes outside 1 … 16384, samples, line width,
/// background), kUnsuitable when a material's picture cannot be decoded, kNoGraphics when the device cannot hold the
/// picture or the mesh.
Result<Image> render(gl::Context& context, const Mesh& mesh, const Camera& camera, const RenderOptions& options = {},
                     std::span<const Segment3> segments = {});

/// A colour for a level in [0, max_level]: dark blue at 0 through green to yellow (the same in docs and legends).
Vec3 level_color(float level, float max_level);

}  // namespace limn
