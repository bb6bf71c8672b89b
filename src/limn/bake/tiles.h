#pragma once

#include "limn/bake/texel_map.h"
#include "limn/base/result.h"
#include "limn/mesh/mesh.h"

namespace limn::bake_detail {

/// Texture tiles as published (Sander et al. 2000, section 4): right triangles of one size, two to a square.
///
/// A square of s texels holds two triangles with legs of s − 3 · 2^k − 1 texels (k = 0: s − 3), their right angles
/// in opposite corners. Corners lie on texel centres, legs run through texel centres. Every texel of the square belongs
/// to the triangle on its side of the diagonal. Squares begin at multiples of 2^k. So bilinear lookups anywhere within
/// a triangle, in the picture or any of its mip levels up to k, read texels of that triangle alone: docs/baking.md has
/// the proof. Levels beyond the first need a size that is a multiple of 2^k.
struct TileLayout {
  int size_px = 0;
  int tile_px = 0;          ///< s
  int leg_px = 0;           ///< from one end of a leg to the other
  int columns = 0;          ///< squares side by side
  int clean_mip_level = 0;  ///< k
};

/// The largest tiles of which `faces` fit a picture.
/// \param clean_mip_level  k, or -1: the highest for which the legs lose at most an eighth of the square's side, at
/// most 4 Errors: kInvalidArgument, naming the size needed.
Result<TileLayout> plan_tiles(std::size_t faces, int size_px, int clean_mip_level);

/// The texture coordinates, one a corner: the corner with the widest angle goes to the right angle. None is mirrored.
CornerAttribute<Vec2> tile_uvs(const Mesh& mesh, const TileLayout& layout);

/// The texels; those of squares that are not used, and of half a square where faces are odd in number, belong to none.
/// \pre uvs are tile_uvs() of the mesh
TexelMap tile_texels(const Mesh& mesh, const CornerAttribute<Vec2>& uvs, const TileLayout& layout);

}  // namespace limn::bake_detail
