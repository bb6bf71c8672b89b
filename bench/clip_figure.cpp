#include "clip_figure.h"

#include <fmt/format.h>

#include "limn/compare/outline.h"

#include "plot.h"

namespace limn::bench {
namespace {

constexpr std::size_t kLevels = 8;

Result<double> outline_error(const Mesh& mesh, const Mesh& original, const FrameSettings& settings) {
  CompareOptions options;
  options.views = 8;
  options.size_px = settings.size_px;
  options.perspective = true;
  const auto compared = compare_meshes(mesh, original, options);
  if (!compared) return tl::unexpected(compared.error());
  return compared->overall.mean_px;
}

Result<FigurePoint> point_of(Result<double> ms, const Mesh& mesh, const Mesh& original, const FrameSettings& settings) {
  if (!ms) return tl::unexpected(ms.error());
  const auto error = outline_error(mesh, original, settings);
  if (!error) return tl::unexpected(error.error());
  return FigurePoint{mesh.face_count(), *ms, *error};
}

Result<void> add(std::vector<FigurePoint>& points, const Result<FigurePoint>& point) {
  if (!point) return tl::unexpected(point.error());
  points.push_back(*point);
  return {};
}

ClipAsset with_level(const ClipAsset& asset, const Mesh& mesh) {
  ClipAsset one = asset;
  one.levels.clear();
  one.levels.push_back({{}, 0.0f, {}});
  one.levels.front().mesh.positions = mesh.positions;
  one.levels.front().mesh.faces = mesh.faces;
  return one;
}

Series series_of(const std::string& name, const char* color, bool dashed, const std::vector<FigurePoint>& points) {
  Series series{name, color, dashed, {}, {}};
  for (const FigurePoint& point : points) {
    if (!(point.mean_px > 0)) continue;  // the original itself lies nowhere on a logarithmic axis
    series.x.push_back(point.ms);
    series.y.push_back(point.mean_px);
  }
  return series;
}

}  // namespace

Result<Figure> measure_figure(gl::Context& context, const SubjectName& about, const std::filesystem::path& models,
                              const FrameSettings& settings) {
  const auto subject = make_subject(about, models, kLevels);
  if (!subject) return tl::unexpected(subject.error());
  Figure figure;
  figure.name = about.name;
  Result<void> state;
  for (const SilhouetteLevel& level : subject->asset.levels) {
    const std::size_t faces = level.mesh.face_count();
    const Mesh simplified = level.error == 0 ? subject->original : simplified_to(subject->original, faces);
    state = add(figure.simplified, point_of(time_plain(context, simplified, subject->asset.bounds, settings),
                                            simplified, subject->original, settings));
    if (!state) break;
    state = add(figure.clipped, point_of(time_clipped(context, with_level(subject->asset, level.mesh), settings),
                                         level.mesh, subject->original, settings));
    if (!state) break;
    // A simplified mesh may lose closedness where parts meet; then there is no silhouette to clip to.
    const auto ms = time_clipped(context, with_level(subject->asset, simplified), settings);
    if (!ms) continue;
    state = add(figure.clipped_simplified, point_of(ms, simplified, subject->original, settings));
    if (!state) break;
  }
  if (!state) return tl::unexpected(state.error());
  return figure;
}

std::string figure_svg(const std::vector<Figure>& figures) {
  std::vector<Plot> plots;
  for (const Figure& figure : figures) {
    Plot plot{figure.name, "ms a frame", "mean outline error, pixels", true, true, {}};
    plot.series = {series_of("simplified", "#c8511b", false, figure.simplified),
                   series_of("clipped", "#1f6fb4", false, figure.clipped),
                   series_of("to simplified", "#1f6fb4", true, figure.clipped_simplified)};
    plots.push_back(std::move(plot));
  }
  return plot_svg(plots);
}

}  // namespace limn::bench
