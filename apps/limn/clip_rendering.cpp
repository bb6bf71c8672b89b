#include "clip_rendering.h"

#include <cstring>

#include "limn/asset/asset_file.h"
#include "limn/base/file.h"

namespace limn::cli {

void add_clip_options(OptionTable& table, ClipDrawFlags& flags) {
  table.choice("--aa", flags.smoothing,
               {{"none", ClipSmoothing::kNone}, {"lines", ClipSmoothing::kLines}, {"msaa", ClipSmoothing::kMsaa}},
               "outlines of --method clip: msaa (default): 4 samples; lines: soft lines");
  table.choice("--interior", flags.interior, {{"hull", ClipInterior::kHull}, {"march", ClipInterior::kMarch}},
               "outlines inside the picture: march (default): the original's; hull: polygons, quicker");
  table.number("--level-tolerance", "PX", flags.tolerance_px, {0.0, 1e6},
               "error of the silhouette of --method clip, in pixels; 0: none (default 0.25)");
}

Result<ClipAsset> load_clip_asset(const std::string& path) {
  const Result<FileBytes> file = FileBytes::open(path);
  if (!file) return tl::unexpected(file.error());
  const std::span<const std::byte> bytes = file->bytes();
  if (bytes.size() < 4 || std::memcmp(bytes.data(), "glTF", 4) != 0) {
    return fail_at(ErrorCode::kUnreadable, path == "-" ? "standard input" : path, {}, "is no clip asset",
                   "make one of it: limn clip MODEL -o OUT.glb");
  }
  Result<ClipAsset> asset = read_clip_asset(bytes, path);
  if (asset || asset.error().code != ErrorCode::kUnreadable) return asset;
  Error error = asset.error();
  if (error.remedy.empty()) error.remedy = "--method clip draws what limn clip MODEL -o OUT.glb writes";
  return tl::unexpected(std::move(error));
}

Result<ClipPicture> draw_clip_asset(gl::Context& context, const ClipAsset& asset, const Camera& camera,
                                    const RenderOptions& options, const ClipDrawFlags& flags) {
  auto model = ClipModel::create(context, asset);
  if (!model) return tl::unexpected(model.error());
  RenderOptions drawing = options;
  drawing.samples = flags.smoothing == ClipSmoothing::kMsaa ? 4 : 1;
  ClipDrawOptions clip;
  clip.antialias = flags.smoothing == ClipSmoothing::kLines ? ClipAntialias::kLines : ClipAntialias::kNone;
  clip.level_tolerance_px = static_cast<float>(flags.tolerance_px);
  clip.interior.way = flags.interior;
  const ClipInstance instance{&*model, Mat4(1.0f)};
  return render_clipped(context, std::span(&instance, 1), camera, drawing, clip);
}

}  // namespace limn::cli
