#pragma once

#include <string>
#include <vector>

#include "limn/mesh/mesh.h"

namespace limn::test {

/// A mesh that has broken somebody's code before, with what is true of it.
struct StableMesh {
  std::string name;
  Mesh mesh;
  bool closed = false;    ///< every edge has exactly two faces, once welded
  bool manifold = false;  ///< no edge has more than two faces
};

/// The stable of awkward meshes every property test runs over: open sheet, hard-edged cube, sphere with a texture seam,
/// degenerate faces, duplicate faces, non-manifold edge, non-manifold vertex, nested shells, self-intersection,
/// needles, huge and tiny coordinates, far from the origin, one triangle, empty, flipped face, Möbius band, stray
/// vertices. All coordinates are finite; every index in range.
std::vector<StableMesh> awkward_meshes();

}  // namespace limn::test
