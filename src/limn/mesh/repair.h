#pragma once

#include <string>
#include <vector>

#include "limn/mesh/mesh.h"

namespace limn {

struct Repair {
  Mesh mesh;
  std::vector<std::string> changes;  ///< one line a kind of change, with its count; empty when nothing was done
};

/// Removes what no technique can use and nobody can see: faces without area, exact duplicates of faces, unused
/// vertices; turns faces so that neighbours agree, outwards when closed. Moves no vertex. Never called unless asked
/// for.
Repair repair(const Mesh& mesh);

}  // namespace limn
