#pragma once

#include <span>
#include <string>
#include <vector>

#include "limn/base/camera.h"
#include "limn/base/result.h"
#include "limn/mesh/mesh.h"

#include "parse_value.h"

namespace limn::cli {

/// Draws meshes side by side from one camera, each with its triangles and outline, into a PNG of `size`.
/// Gives what drawing each took, in milliseconds. Errors: kNoGraphics, also where limn was built without OpenGL;
/// kUnwritable.
Result<std::vector<double>> draw_demo(std::span<const Mesh* const> meshes, const Camera& camera, const Size& size,
                                      const std::string& path);

}  // namespace limn::cli
