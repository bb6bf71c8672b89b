#pragma once

#include <vector>

#include "limn/bake/bake.h"
#include "limn/bake/shoot.h"
#include "limn/bake/surface.h"
#include "limn/bake/texel_map.h"

namespace limn::bake_detail {

/// A face of the low mesh as texels need it.
struct LowFace {
  Vec3 position[3];  ///< in the unit frame
  Vec3 normal[3];
  Vec4 tangent[3];      ///< only for tangent_normals
  float footprint = 0;  ///< of a texel on the face, in the meshes' units
};

/// Everything that filling texels reads.
struct BakeScene {
  const UnitFrame& frame;
  const Target& target;
  const Surface& surface;
  const TexelMap& texels;
  const std::vector<LowFace>& low;
  const BakeOptions& options;
};

/// Fills the maps that `maps` has room for, and the report's figures of texels. In blocks of 8 × 8 texels, which are
/// neighbours on the surface as well: their rays run through the tree together.
/// Same bits for any number of threads. Errors: kCancelled.
Result<void> fill_texels(const BakeScene& scene, BakedMaps& maps);

}  // namespace limn::bake_detail
