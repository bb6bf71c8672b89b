#pragma once

#include <filesystem>
#include <vector>

#include "limn/base/bounds.h"
#include "limn/base/result.h"
#include "limn/image/image.h"
#include "limn/mesh/mesh.h"

namespace limn {

/// A closed mesh whose exact silhouette clips the hull: the original, or a coarser member of its hull sequence.
struct SilhouetteLevel {
  Mesh mesh;        ///< positions and faces only, welded; the search structure is built from, or read for, exactly this
  float error = 0;  ///< how far it lies from the original at most, in the model's units; 0 for the original itself
  /// The search tree, as the leaf of each edge of build_topology(mesh) (silhouette/search/leaf_partition.h): the
  /// clusters that SilhouetteExtractor takes are partition_clusters() of it. Empty: not made yet.
  std::vector<std::uint32_t> leaf_of_edge;
};

/// What the renderer reads besides the hull's own material, in texture space of the hull's uvs.
struct DetailMaps {
  Image normals;                            ///< object space, 0.5 + 0.5 n; may be empty
  Image colors;                             ///< sRGB; may be empty
  std::vector<std::uint16_t> displacement;  ///< a texel each, row by row from the top: along the interpolated normal
  int displacement_width = 0, displacement_height = 0;
  float displacement_low = 0, displacement_high = 0;  ///< what 0 and 65535 stand for, in the model's units
};

/// A dense model as a small asset: a coarse hull with baked maps, and the original's silhouette to clip it to.
/// Sander et al. 2000; docs/asset.md
struct ClipAsset {
  Mesh hull;  ///< encloses every level; normals, uvs of its maps, one material with a tangent-space normal map
  std::vector<SilhouetteLevel> levels;  ///< finest first, at least one; errors ascend
  DetailMaps maps;
  Bounds bounds;  ///< of the original
};

}  // namespace limn
