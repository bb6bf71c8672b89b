#pragma once

#include <string>

#include "limn/base/camera.h"
#include "limn/base/result.h"
#include "limn/gl/context.h"
#include "limn/render/clip/clip_picture.h"

#include "option_table.h"

namespace limn::cli {

/// How `render --method clip` smooths outlines.
enum class ClipSmoothing { kNone, kLines, kMsaa };

struct ClipDrawFlags {
  ClipSmoothing smoothing = ClipSmoothing::kMsaa;
  double tolerance_px = 0.25;
  ClipInterior interior = ClipInterior::kMarch;
};

/// --aa, --interior and --level-tolerance.
void add_clip_options(OptionTable& table, ClipDrawFlags& flags);

/// Reads a clip asset. Errors: kUnreadable as read_clip_asset(), with the way to make one.
Result<ClipAsset> load_clip_asset(const std::string& path);

/// Draws it. \param options  samples are those of the smoothing. Errors: as ClipModel::create() and render_clipped().
Result<ClipPicture> draw_clip_asset(gl::Context& context, const ClipAsset& asset, const Camera& camera,
                                    const RenderOptions& options, const ClipDrawFlags& flags);

}  // namespace limn::cli
