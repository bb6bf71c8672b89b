#pragma once

#include <cstddef>
#include <string>

#include "limn/mesh/mesh.h"

namespace limn::test {

struct EnclosureOptions {
  std::size_t faces = 500;      ///< of the hulls
  std::size_t samples = 1000;   ///< points on the surface that must be enclosed
  std::size_t elsewhere = 100;  ///< points off both surfaces, where winding numbers are compared
  bool strict = false;
};

/// What was looked at for one mesh, outer and inner hull together.
struct EnclosureTally {
  std::size_t hulls = 0, reached = 0;  ///< made; made with as few faces as asked for
  std::size_t vertices = 0, samples = 0, elsewhere = 0;
  std::size_t on_surface = 0;  ///< of the vertices and samples: on the hull itself
  std::size_t outside = 0;     ///< must be 0
  /// Outside, but where the surface itself winds backwards, so that nothing inside is near; not counted in `outside`.
  std::size_t nothing_inside = 0;
  std::size_t strays = 0;  ///< vertices of inner hulls among those
  std::size_t lost = 0;    ///< of elsewhere: inside the enclosed surface alone; must be 0
  std::size_t steps = 0, proved = 0;
  std::size_t crossings = 0;  ///< pairs of faces that intersect in hulls whose shell had none
  std::string refused;        ///< why no shell was made
  std::string objection;      ///< what is wrong, first thing found; empty when nothing is

  void add(const EnclosureTally& other);
};

/// Makes the outer and the inner hull of the mesh and proves them: every vertex of the enclosed surface, and points
/// spread over it, inside or on the enclosing one; no point anywhere inside the enclosed one alone; and the certificate
/// of every step, from the bytes of the saved sequence alone. Winding numbers are exact (support/winding.h), and so are
/// the points: their coordinates are on the faces without rounding.
EnclosureTally prove_enclosure(const Mesh& mesh, const EnclosureOptions& options, std::uint64_t seed);

}  // namespace limn::test
