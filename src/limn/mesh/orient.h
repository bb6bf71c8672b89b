#pragma once

#include <cstdint>
#include <vector>

#include "limn/mesh/mesh.h"
#include "limn/mesh/topology.h"

namespace limn {

/// Which faces to turn around so that neighbours agree.
struct Orientation {
  std::vector<std::uint8_t> turn;  ///< one a face: 1 to turn it
  std::size_t to_agree = 0;        ///< faces turned because their neighbours wind the other way
  std::size_t outwards = 0;        ///< faces of closed components that agreed with one another, but wound inwards
  std::size_t outwards_components = 0;
};

/// Winds every component (faces connected across edges of two faces) the way most of its faces wind already; then turns
/// closed components of negative volume outwards, unless their box lies inside that of another closed component: such
/// a shell may be the wall of a cavity, and is left as it is. One-sided components (a Möbius band) are left alone.
/// Ties keep the component's lowest face. Cost: linear, and the square of the number of closed components in the worst
/// case. \pre topology was built from this mesh
Orientation find_orientation(const Mesh& mesh, const Topology& topology);

}  // namespace limn
