#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "limn/asset/clip_asset.h"
#include "limn/base/result.h"

namespace limn {

/// What a clip asset's file is made of, in bytes.
struct AssetBytes {
  struct Level {
    std::size_t faces = 0;
    float error = 0;
    std::size_t mesh = 0;    ///< vertices and faces
    std::size_t search = 0;  ///< the search tree
  };
  std::size_t file = 0;
  std::vector<Level> levels;
  std::size_t normals = 0, colors = 0, displacement = 0;  ///< what a renderer of ours reads beside the hull's material
  /// The hull with its pictures, and the JSON: what any viewer reads.
  std::size_t rest() const;
};

/// Writes an asset as one GLB: the hull with its material for any viewer, all else in the extension LIMN_silhouette
/// (docs/asset.md). Whole or not at all; the same asset gives the same bytes. Where a level has no search tree yet, the
/// file has none. \return what it is made of
///
/// \pre indices in range. Levels are smallest in the order of order_for_storage() (asset/mesh_codec.h).
/// Errors: kUnwritable; kInvalidArgument for an asset that cannot be read back: no hull, no levels, coordinates that
/// are not finite, errors that do not ascend, a search tree of another mesh, maps of another size than they say.
Result<AssetBytes> write_clip_asset(const ClipAsset& asset, const std::filesystem::path& path);

/// Reads an asset. Levels, their search trees, maps and bounds come back bit for bit; the hull as read_mesh() reads it.
///
/// Guarantees: as of read_mesh(); levels have faces, indices in range, finite coordinates, search trees, where the file
/// has them, that hold every edge of exactly that mesh, ascending errors. Whatever the bytes are, memory stays within a
/// multiple of their number, and what is read finds the exact silhouettes of the meshes it gives. Cost: about 0.5 µs a
/// triangle of the levels. Errors: kUnreadable, with file, place and remedy: no such file, not a clip asset, of another
/// version, cut off, any byte altered, or written by another program.
Result<ClipAsset> read_clip_asset(const std::filesystem::path& path);

/// The same from memory. \param name stands for the file in messages
Result<ClipAsset> read_clip_asset(std::span<const std::byte> bytes, std::string_view name);

/// What the file is made of, without decoding it. Errors: as read_clip_asset.
Result<AssetBytes> measure_clip_asset(std::span<const std::byte> bytes, std::string_view name);

/// Whether the bytes are those of a clip asset, whole or not: a GLB with the extension.
bool holds_clip_asset(std::span<const std::byte> bytes);

}  // namespace limn
