#pragma once

#include <cstddef>
#include <limits>

#include "limn/base/vec.h"
#include "limn/hull/ring_surface.h"

namespace limn {

/// What the exact tests of a hull's steps add up to.
struct Certificate {
  std::size_t tests = 0;  ///< orientation tests that steps rest on
  /// The least distance of a new vertex from a plane it has to lie outside of, in the mesh's units.
  double worst_margin = std::numeric_limits<double>::infinity();

  void add(const Certificate& other) {
    tests += other.tests;
    if (other.worst_margin < worst_margin) worst_margin = other.worst_margin;
  }
};

/// Whether a point lies outside or in the planes of all faces around v, but for those at `skip` (kInvalidId: none):
/// exactly, on the coordinates that the surface holds. `certificate` gets the tests, whatever they say.
bool is_outside_faces(const RingSurface& surface, VertexId v, VertexId skip, const Vec3& point,
                      Certificate& certificate);

/// The same of one triangle.
bool is_outside_face(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& point, Certificate& certificate);

}  // namespace limn
