#pragma once

#include "limn/base/result.h"
#include "limn/mesh/mesh.h"

namespace limn::bench {

/// The mesh's outer hull of so many faces, without texture coordinates, or of more where fewer are not reached.
Result<Mesh> coarse_mesh(const Mesh& mesh, std::size_t faces);

}  // namespace limn::bench
