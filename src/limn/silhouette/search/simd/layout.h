#pragma once

// What the kernels read and write. Plain data alone: the kernels' sources are compiled for instruction sets that the
// machine may lack, so they must share no inline function with the rest of the program.

#include <cstddef>
#include <cstdint>

namespace limn::simd {

inline constexpr int kWidth = 16;  ///< children of a node, faces and edges of a leaf, faces of a plane group

/// Quantized planes of 16 faces or nodes: pairs (n_x, n_y) and (n_z, d), so that one multiply-add of pairs
/// (pmaddwd) takes each half of the dot product.
struct alignas(64) PlaneGroup {
  std::int16_t xy[2 * kWidth];
  std::int16_t zd[2 * kWidth];
};

/// 16 nodes of the search tree: the planes of each lie within r of its normal, and within h of its offset.
struct alignas(64) NodeGroup {
  PlaneGroup planes;
  std::int16_t rh[2 * kWidth];  ///< pairs (r, h)
  float center[3];              ///< the nodes' anchors lie within `radius` of it; in shares of the frame's scale
  float radius;
};

/// A leaf: at most 16 faces and at most 16 edges between them.
struct alignas(64) Leaf {
  PlaneGroup planes;
  std::uint8_t sides[kWidth];  ///< the edge's two faces within the leaf, in 4 bits each; equal for an unused slot
  std::uint32_t edges[kWidth];
};

/// A plane group of the exact planes.
struct alignas(64) ExactGroup {
  float x[kWidth], y[kWidth], z[kWidth], d[kWidth];
};

/// Sides of 64 edges of a block. A byte holds a face's number within the block: its upper 3 of 7 bits in the low
/// nibble's place and its lower 3 bits in the high nibble's, ready for byte shuffles: (face & 7) << 4 | face >> 3.
struct alignas(64) EdgeSides {
  std::uint8_t first[64];
  std::uint8_t second[64];
};

inline constexpr int kBlockFaces = 128;
inline constexpr int kBlockEdges = 128;

/// A block of the brute force: up to 128 faces and up to 128 edges between them. Kernels may read 8 plane groups from
/// the first on, whether they are the block's or not.
struct Block {
  std::uint32_t group;  ///< first plane group; faces lie at 16 * group
  std::uint32_t sides;  ///< first EdgeSides; edges lie at 64 * sides
  std::uint16_t groups;
  std::uint16_t sides_count;
};

/// Tells the facing of up to 16 faces exactly. \param mask those to tell \return their bits, a subset of mask
using ExactFacing = std::uint32_t (*)(const void* context, const std::uint32_t* faces, std::uint32_t mask);

/// The eye as the kernels see it (quantized.h).
struct EyeWords {
  std::int16_t x, y, z, h;
  std::int32_t error;  ///< |value| <= error: the quantized planes cannot tell
  float v[3];          ///< x, y, z before they were rounded
  float scale;         ///< h before it was rounded: the frame's scale in the eye's units
  std::int32_t reach;  ///< the distance to every anchor in these units, when orthographic
  float at[3];         ///< as the exact test takes it
  bool orthographic;
  bool decisive;        ///< false: every value is within `error`, nodes tell nothing
  const void* context;  ///< for `exact`
  ExactFacing exact;
};

/// Where the eye goes from here: within a cone about a direction, or anywhere (direction 0). Planes' values are those
/// of the EyeWords that come with it.
struct Heading {
  std::int16_t x, y, z;  ///< the direction, times kHeadingWord, rounded
  float along;           ///< what a plane's product with the direction adds to its value, a unit of way
  float drift;           ///< what roundings and the width of the cone may add, a unit of way; above 0
};

inline constexpr int kHeadingWord = 16383;

/// What became of leaves: their silhouettes kept up to date, and what changed.
struct LeafChanges {
  std::uint16_t* silhouettes;   ///< of all leaves: a bit for each edge; read and written
  const std::uint32_t* places;  ///< 16 numbers of each leaf, fetched ahead for who comes next
  std::uint32_t* added;         ///< slots, 16 * leaf + edge, in order
  std::uint32_t* removed;
  float* safe;  ///< for each leaf looked at, how long a way its faces surely keep their sides for; 0 or more
  /// If not null: which of the leaves need the exact test, and for which faces. They are left as they are, and what the
  /// test reads is fetched meanwhile.
  std::uint32_t* unsure;
  std::uint32_t* unsure_faces;
  std::size_t added_count, removed_count, unsure_count;  ///< what was written; 0 before
};

/// Output arrays must have room for 16 more numbers than are written.
struct Kernels {
  /// Numbers of the children (16 * group + lane) that may hold a silhouette, in order. \param groups null: 0 … count-1
  std::size_t (*sweep_groups)(const NodeGroup* nodes, const std::uint32_t* groups, std::size_t count,
                              const EyeWords& eye, std::uint32_t* children);
  /// Silhouette edges of leaves. \param leaf_faces 16 a leaf \param leaves null: 0 … count-1
  std::size_t (*sweep_leaves)(const Leaf* nodes, const std::uint32_t* leaf_faces, const std::uint32_t* leaves,
                              std::size_t count, const EyeWords& eye, std::uint32_t* edges);
  /// Slots (64 * sides + lane) of the silhouette edges of blocks with quantized planes.
  std::size_t (*sweep_blocks)(const Block* blocks, std::size_t count, const PlaneGroup* planes,
                              const std::uint32_t* faces, const EdgeSides* sides, const EyeWords& eye,
                              std::uint32_t* slots);
  /// The same with exact planes.
  std::size_t (*sweep_exact_blocks)(const Block* blocks, std::size_t count, const ExactGroup* planes,
                                    const EdgeSides* sides, const EyeWords& eye, std::uint32_t* slots);
  /// Looks at leaves again. \param leaves each at most once
  void (*update_leaves)(const Leaf* nodes, const std::uint32_t* leaf_faces, const std::uint32_t* leaves,
                        std::size_t count, const EyeWords& eye, const Heading& heading, LeafChanges& changes);
  /// Indices of the numbers that are at most `way`, in order. Reads up to 15 numbers past the last.
  std::size_t (*find_due)(const float* ways, std::size_t count, float way, std::uint32_t* indices);
};

extern const Kernels kScalarKernels;
#if defined(__x86_64__)
extern const Kernels kAvx2Kernels;
extern const Kernels kAvx512Kernels;
#endif

}  // namespace limn::simd
