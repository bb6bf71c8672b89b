#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "limn/base/result.h"
#include "limn/mesh/mesh.h"

namespace limn {

/// Procedural meshes with exact normals and texture coordinates, about the origin, within the unit sphere or near it.
enum class Shape { kTetrahedron, kCube, kIcosphere, kTorus, kKnot, kHoles3, kAsteroid, kSheet, kTerrain };

struct ShapeOptions {
  std::size_t faces = 0;   ///< wanted number of faces, met as nearly as the shape allows; 0: the shape's own default
  std::uint64_t seed = 1;  ///< asteroid and terrain
};

/// All shapes in the order of the enumeration, with the names the command line uses ("holes3").
struct ShapeInfo {
  Shape shape;
  std::string_view name;
  std::string_view what;  ///< one line
};
std::span<const ShapeInfo> shapes();

/// Makes a shape. Closed shapes are watertight by position; the cube has hard edges (normals split), the torus, knot
/// and icosphere have texture seams. Same options, same bits.
/// Errors: kInvalidArgument when `faces` is beyond 100 million (about 12 GB) or below the shape's smallest.
Result<Mesh> make_shape(Shape shape, const ShapeOptions& options = {});

}  // namespace limn
