#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "limn/asset/clip_asset.h"
#include "limn/bake/bake.h"
#include "limn/base/progress.h"
#include "limn/base/result.h"
#include "limn/hull/progressive_hull.h"
#include "limn/mesh/mesh.h"

namespace limn {

/// Which maps an asset gets beside the hull's tangent-space normal map, which it always has.
struct ClipMaps {
  bool normals = true;  ///< object space: what limn's own renderer shades with
  bool colors = true;   ///< where the original has any
  bool displacement = true;
};

struct ClipOptions {
  std::size_t faces = 500;  ///< of the hull, at least 4
  bool strict = false;      ///< a hull without self-intersections, where the original has none
  std::size_t levels = 4;   ///< silhouettes at most, the original's included, 1 to 32
  int size_px = 1024;       ///< width and height of the maps, 4 to 16384
  int samples = 1;          ///< a texel: 1, 4 or 16
  ClipMaps maps{};
  Progress progress{};  ///< stages "hull", "silhouettes", "maps"
};

/// What was reached on the way.
struct ClipReport {
  HullReport hull;
  BakeReport bake;
  std::vector<std::string> notes;  ///< what was changed to make a closed surface of the original
  double hull_ms = 0, silhouettes_ms = 0, maps_ms = 0;
};

struct BuiltClipAsset {
  ClipAsset asset;
  ClipReport report;
};

/// Makes a clip asset of a dense mesh: its hull, the hull's maps, and the silhouettes it is clipped to. All that
/// Sander et al. 2000 do before run time; docs/asset.md.
///
/// The first silhouette is that of the shell (hull/shell.h): the welded original, exactly, where it is closed; else
/// with its boundaries closed, which the notes say. The hull comes as one value a vertex and, but for its tangents, as
/// a file gives it back, so that an asset just built and one that was read draw the same pixels. A hull that cannot be
/// brought down to `faces` is success: see HullReport::reached_target.
///
/// Cost: about 15 µs a face of the original and 0.3 µs a texel, on one core. Same bits for any number of threads.
/// Errors: kInvalidArgument; kUnsuitable where no closed surface can be made of the mesh; kCancelled.
Result<BuiltClipAsset> build_clip_asset(const Mesh& original, const ClipOptions& options = {});

}  // namespace limn
