#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "limn/base/vec.h"
#include "limn/mesh/mesh.h"

namespace limn {

/// A face of a hull as the march through its shell reads it: the twin of ShellFace in shaders/clip_shell.glsl.
struct ShellFace {
  std::array<Vec4, 3> corner;           ///< xyz: place; w: u
  std::array<Vec4, 3> direction;        ///< xyz: unit normal; w: v, downwards
  std::array<std::uint32_t, 4> across;  ///< of edge c: the face beyond, times 4, plus which of its edges; [3] is unused
};
static_assert(sizeof(ShellFace) == 112);

/// One a face of the hull. Where an edge has no face beyond it, or several, across is kInvalidId.
/// Normals are the mesh's own: the shell has no gaps where those of a place are equal in all faces there.
/// \pre the mesh has texture coordinates and normals. Cost: a few linear passes. Same result for any number of threads.
std::vector<ShellFace> shell_faces(const Mesh& hull);

}  // namespace limn
