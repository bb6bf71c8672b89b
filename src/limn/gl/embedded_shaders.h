#pragma once

#include <span>
#include <string_view>

namespace limn::gl {

/// A file of the shaders folder as it was when limn was built.
struct EmbeddedShader {
  std::string_view name;  ///< "face.vert.glsl"
  std::string_view text;
};

/// Every one of them, by name. The source is written at build time by cmake/LimnShaders.cmake.
std::span<const EmbeddedShader> embedded_shaders();

}  // namespace limn::gl
