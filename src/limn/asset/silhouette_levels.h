#pragma once

#include <vector>

#include "limn/asset/clip_asset.h"
#include "limn/base/progress.h"
#include "limn/base/result.h"
#include "limn/hull/progressive_hull.h"

namespace limn::asset {

/// The silhouettes of a hull built with keep_steps: the shell itself, then members of its sequence, each a quarter of
/// the faces of the one before, as long as that is at least twice those of the hull. Each encloses those before it and
/// lies within the hull, so that it clips the hull rightly. In the order of order_for_storage(), with search trees.
///
/// \param most  levels at most, at least 1
/// Cost: about 3 µs a face of the shell, most of it for the errors (surface_distance.h). Same bits for any number of
/// threads. Errors: those of HullSequence::make(), kCancelled.
Result<std::vector<SilhouetteLevel>> silhouette_levels(const Hull& hull, std::size_t most, const Progress& progress);

/// The leaves of the search tree over a mesh (SilhouetteLevel::leaf_of_edge).
std::vector<std::uint32_t> search_leaves(const Mesh& mesh);

}  // namespace limn::asset
