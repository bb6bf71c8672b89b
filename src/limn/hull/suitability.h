#pragma once

#include <vector>

#include "limn/mesh/mesh.h"
#include "limn/mesh/validate.h"

namespace limn {

/// Whether hulls can be made of the mesh ("hull") and its silhouette clip them ("clip"): just what make_shell says of
/// it (docs/hull-input.md). Reasons: its error, or its notes. Cost: that of make_shell. Same result for any number of
/// threads. \pre every index is in range, every position finite
std::vector<Suitability> solid_suitability(const Mesh& mesh);

}  // namespace limn
