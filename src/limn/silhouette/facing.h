#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "limn/mesh/mesh.h"
#include "limn/silhouette/eye.h"

namespace limn {

/// The plane n·x + d = 0 of a face; n is of unit length and points to the front, or 0 for a face without area.
struct Plane {
  float nx, ny, nz, d;
};

/// One plane a face, built in double and rounded once. Same bits for any number of threads.
std::vector<Plane> face_planes(const Mesh& mesh);

/// Whether the face is seen from the front: n·x + d > 0 for an eye at a point, n·x > 0 for one at infinity; exactly 0
/// is back, as is a face without area. Plain multiplications and additions in this order, never contracted, so that
/// every extractor, on the CPU or GPU, gives the same answer bit for bit (docs/silhouette.md).
inline bool faces_eye(const Plane& plane, const Eye& eye) {
  const float side =
      plane.nx * eye.at.x + plane.ny * eye.at.y + plane.nz * eye.at.z + (eye.orthographic ? 0.0f : plane.d);
  return side > 0.0f;
}

/// faces_eye of every face: 1 front, 0 back. \param facing resized to planes.size()
void classify_faces(std::span<const Plane> planes, const Eye& eye, std::vector<std::uint8_t>& facing);

}  // namespace limn
