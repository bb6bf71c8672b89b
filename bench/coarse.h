#pragma once

#include "limn/base/result.h"
#include "limn/mesh/mesh.h"

namespace limn::bench {

/// A coarse mesh around a fine one, with smooth normals: meshoptimizer's reduction, its vertices moved outwards by a
/// hundredth of the model's diagonal.
Result<Mesh> coarse_mesh(const Mesh& mesh, std::size_t faces);

}  // namespace limn::bench
