#pragma once

#include <string>
#include <vector>

#include "limn/mesh/mesh.h"

namespace limn {

struct Repair {
  Mesh mesh;
  std::vector<std::string> changes;  ///< one line a kind of change, with its count; empty when nothing was done
};

/// Removes what no technique can use and nobody can see: faces without area, exact copies of faces (same vertices, same
/// sense), unused vertices; turns faces so that neighbours agree, outwards when closed. Moves no vertex. Never called
/// unless asked for.
///
/// A face of three distinct collinear corners stays where all its edges hold on to one other face each: without it the
/// surface would come apart. A component takes the winding most of its faces have; a closed one that winds inwards is
/// turned, unless its box lies inside that of another closed component, where it may be the wall of a cavity. One-sided
/// components stay as they are. Normals that would point behind a turned face are turned with it.
/// Cost: a few passes and sorts of the faces, however many faces without area lie behind one another. Same mesh, same
/// bits. \pre indices in range, positions finite
Repair repair(const Mesh& mesh);

}  // namespace limn
