#pragma once

#include <string>
#include <vector>

#include "limn/base/result.h"
#include "limn/mesh/topology.h"

namespace limn {

/// A face's side as one number: 3 * face + c, from corner c to corner (c + 1) % 3.
using SideId = std::uint32_t;

inline SideId next_side(SideId side) {
  return side % 3 == 2 ? side - 2 : side + 1;
}
inline SideId previous_side(SideId side) {
  return side % 3 == 0 ? side + 2 : side - 1;
}

/// Which sides of faces hang together once a mesh is taken for the border of a solid.
struct SidePairs {
  std::vector<std::uint8_t> alive;  ///< one a face: 0 for those taken out
  std::vector<SideId> twin;         ///< one a side: the side that runs back along it; kInvalidId on a boundary
  std::vector<std::string> notes;   ///< what was taken out
};

/// Takes out faces with two equal corners and pairs of faces that cancel (the same three vertices, turned over), takes
/// copies of a face out where they leave a side without a partner, and pairs the sides of what is left, at every edge
/// one that runs along it with one that runs back.
///
/// Where several pairs meet at an edge, sides are paired by angle as brackets are: across the wedges inside, so that
/// neither two pairs cross each other there nor solids that touch along the edge hang together.
/// Cost: a few linear passes. Same bits for any number of threads.
/// \pre topology was built from this mesh
/// Errors: kUnsuitable, naming the edge and its faces, where two sides or more are left over at an edge, all running
/// the same way.
Result<SidePairs> pair_sides(const Mesh& mesh, const Topology& topology);

}  // namespace limn
