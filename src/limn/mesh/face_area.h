#pragma once

#include <cmath>
#include <glm/geometric.hpp>

#include "limn/mesh/mesh.h"

namespace limn {

/// Twice the area of a face along its normal, in double. Zero exactly when its corners are collinear, up to the
/// rounding of double: no float mesh, however large or small, overflows or vanishes in it.
inline DVec3 twice_area_vector(const Mesh& mesh, FaceId face) {
  const Triangle& t = mesh.faces[face];
  const DVec3 a(mesh.positions[t[0]]);
  return glm::cross(DVec3(mesh.positions[t[1]]) - a, DVec3(mesh.positions[t[2]]) - a);
}

}  // namespace limn
