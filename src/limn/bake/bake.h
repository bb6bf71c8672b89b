#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "limn/base/progress.h"
#include "limn/base/result.h"
#include "limn/image/deep_image.h"
#include "limn/image/image.h"
#include "limn/mesh/mesh.h"

namespace limn {

/// How a point of the low mesh finds its point on the high one.
enum class BakeMethod {
  kShoot,    ///< along the interpolated normal, the closest point on a miss: Sander et al. 2000, section 4
  kClosest,  ///< the closest point always (Cignoni et al. 1998), to compare with
};

/// Where in the picture the low mesh's faces lie.
enum class BakeLayout {
  kAuto,    ///< the low mesh's own texture coordinates where it has some, else tiles
  kTiles,   ///< a right triangle a face, two to a square, all of one size (bake/tiles.h)
  kOwnUvs,  ///< the low mesh's own
};

/// Which maps are made.
struct BakeMapChoice {
  bool object_normals = true;    ///< unit normals of the high mesh in the space both meshes share
  bool tangent_normals = false;  ///< the same in the low mesh's MikkTSpace frames (bake/tangent_space.h)
  bool colors = false;           ///< vertex colours times material times base colour picture; linear RGBA
  bool displacement = false;     ///< from the low mesh to the high one along the interpolated unit normal
  bool occlusion = false;        ///< share of the sky that is seen, cosine weighted: 1 in the open
  bool positions = false;        ///< the point found on the high mesh
};

struct BakeOptions {
  BakeMapChoice maps;
  BakeMethod method = BakeMethod::kShoot;
  BakeLayout layout = BakeLayout::kAuto;
  int size_px = 1024;  ///< width and height of the maps, 4 to 16384
  int samples = 1;     ///< a texel: 1, 4 or 16, on a regular grid, averaged
  /// Mip level up to which a tile's triangle is not mixed with its neighbours; -1: the highest that costs at most an
  /// eighth of a tile's side. Every level costs texels: a tile of s texels holds legs of s − 3 · 2^level − 1.
  int clean_mip_level = -1;
  int gutter_px = 8;  ///< kOwnUvs: texels by which islands grow over the empty space around them
  /// Longest ray, in the meshes' units; 0: no bound. What lies beyond is a miss.
  double max_distance = 0;
  /// A hit that is farther than a twentieth of the high mesh's diagonal, and farther than this many times the closest
  /// point, gives way to that: the ray went past what it should have met. 0: never, as published. docs/baking.md
  double most_stretch = 2;
  int occlusion_rays = 64;        ///< a texel, stratified
  double occlusion_distance = 0;  ///< what is farther does not occlude; 0: everything does
  std::uint64_t seed = 1;         ///< of the occlusion rays
  Progress progress{};
};

/// What was found out on the way.
struct BakeReport {
  std::size_t texels = 0;        ///< texels that belong to a face, gutters of tiles included
  std::size_t samples = 0;       ///< points of the low mesh that were asked, a texel's samples each
  std::size_t misses = 0;        ///< of those: neither direction met the high mesh rightly; 0 for kClosest
  std::size_t overruled = 0;     ///< hits that gave way to closest points, \see BakeOptions::most_stretch; no misses
  double worst_distance = 0;     ///< the longest way from the low mesh to the high one, in the meshes' units
  int worst_x = 0, worst_y = 0;  ///< its texel
  FaceId worst_face = kInvalidId;
  double displacement_low = 0, displacement_high = 0;  ///< over all texels
  std::size_t overlapping_texels = 0;  ///< kOwnUvs: texels whose centre lies within two faces; the first keeps it
  int tile_px = 0;                     ///< kTiles: side of a square of two faces
  int leg_px = 0;                      ///< kTiles: texels along a leg of a triangle, less one
  int clean_mip_level = 0;             ///< kTiles: \see BakeOptions
  double build_ms = 0, shoot_ms = 0;   ///< making the high mesh ready; all texels, padding and misses included
  bool embree = false;                 ///< whether Embree cast the rays, or limn's own tree

  double miss_share() const { return samples > 0 ? static_cast<double>(misses) / static_cast<double>(samples) : 0.0; }
};

/// Maps that were asked for; the others are empty. Texels that belong to no face hold the values named here.
struct BakedMaps {
  /// The low mesh with the texture coordinates and normals that the maps were made for, and without colours: what
  /// `maps` are drawn on. Materials are dropped.
  Mesh mesh;
  /// With tangent_normals: one a corner, xyz along growing u, w the side of the bitangent, as glTF's TANGENT.
  std::vector<Vec4> tangents;
  FloatImage object_normals;   ///< 3 channels, unit length; elsewhere (0, 0, 1)
  FloatImage tangent_normals;  ///< 3 channels, unit length; elsewhere (0, 0, 1)
  FloatImage colors;           ///< 4 channels, linear; elsewhere 0
  FloatImage displacement;     ///< 1 channel, in the meshes' units; elsewhere 0
  FloatImage occlusion;        ///< 1 channel, 0 … 1; elsewhere 1
  FloatImage positions;        ///< 3 channels; elsewhere 0
  std::vector<FaceId> owner;   ///< one a texel, row by row from the top: the low mesh's face, kInvalidId for none
  BakeReport report;
};

/// Samples the high mesh's attributes into maps over the low mesh. Sander et al. 2000, section 4; docs/baking.md.
///
/// A texel's point and normal are interpolated on its face of the low mesh (in the gutter: on the nearest point of the
/// face). A ray runs from there against the normal, inwards; its first hit counts when the face it meets is turned the
/// way the normal points. Else a ray along the normal, outwards, is asked in the same way. Where the high mesh is
/// closed and does not meet itself, one of the two always counts at most: the first from outside, the second from
/// inside. Where neither does, the closest point of the high mesh is taken, and the texel is a miss.
///
/// Normals: the low mesh's own, else smooth ones; the high mesh's own, else creased at 60°. Cost: about 0.15 µs a
/// sample and core with Embree, three times that without. Same bits for any number of threads.
/// Errors: kUnsuitable (a mesh without faces, coordinates that are not finite, kOwnUvs without texture coordinates),
/// kInvalidArgument (options out of range; more faces than the size has room for, naming the size needed), kCancelled.
Result<BakedMaps> bake(const Mesh& high, const Mesh& low, const BakeOptions& options = {});

/// What maps_material() stores.
struct BakedMaterialOptions {
  bool deep = false;  ///< 16-bit PNG instead of 8-bit
  std::string name = "baked";
};

/// The baked mesh with one material that holds its tangent-space normal map and colours, as far as they were made:
/// written by write_mesh() as GLB it opens in any viewer. Errors: those of encode_png().
Result<Mesh> mesh_with_maps(const BakedMaps& maps, const BakedMaterialOptions& options = {});

}  // namespace limn
