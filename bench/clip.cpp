// What does clipping a coarse hull to the original's silhouette cost, and are its pixels the original's?
//
//   clip [--only NAME…] [--models DIR] [--size PX] [--views N] [--seed N] [--json]
//   clip --exact [--inexact] …     counts the pixels that differ from those the original covers
//   clip --figure [--svg FILE] …   time against outline error (Sander et al. 2000, Fig. 11)
//
// Without more: the paper's Table 1, contestants alternating view by view, medians with quartiles. docs/clipping.md
// says what each means.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <fmt/format.h>
#include <fstream>
#include <nlohmann/json.hpp>

#include "limn/base/file.h"
#include "limn/base/parallel.h"

#include "clip_exact.h"
#include "clip_figure.h"
#include "clip_frames.h"

namespace limn::bench {
namespace {

struct Arguments {
  std::vector<std::string> only;
  std::string models = "models", svg;
  FrameSettings frames;
  bool exact = false, inexact = false, figure = false, json = false;
};

/// What all experiments work with.
struct Bench {
  const Arguments* arguments;
  gl::Context* context;
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  std::vector<Figure> figures;
};

std::string text_of(const ClipRow& row) {
  std::string text =
      fmt::format("{} ({} faces, hull {}): {:.0f} silhouette edges, {:.0f} stencil triangles, {:.0f} faces edge on\n",
                  row.name, row.faces, row.hull_faces, row.silhouette_edges, row.stencil_triangles, row.edge_on_faces);
  const std::pair<const char*, const Spread*> lines[] = {{"original", &row.original},
                                                         {"simplified", &row.simplified},
                                                         {"clipped", &row.clipped},
                                                         {"clipped, lines", &row.lines},
                                                         {"original, 4 samples", &row.msaa_original},
                                                         {"clipped, 4 samples", &row.msaa_clipped}};
  for (const auto& [name, s] : lines)
    text += fmt::format("  {:22} {:8.3f} ms ({:.3f}-{:.3f})\n", name, s->median, s->low, s->high);
  text += fmt::format("  stages: extraction {:.3f}, loops {:.3f}, stencil {:.3f}, hull {:.3f}\n", row.extraction,
                      row.loops, row.stencil, row.hull);
  text += fmt::format("  speed-up {:.2f}, with 4 samples {:.2f}; lines add {:+.3f} ms, samples {:+.3f} ms\n",
                      row.original.median / row.clipped.median, row.msaa_original.median / row.msaa_clipped.median,
                      row.lines.median - row.clipped.median, row.msaa_clipped.median - row.clipped.median);
  text += fmt::format(
      "  processor time: original {:.3f}, simplified {:.3f}, clipped {:.3f} ({:.2f} times), lines {:.3f}; 4 samples "
      "{:.3f} "
      "and {:.3f} ms\n",
      row.cpu_original, row.cpu_simplified, row.cpu_clipped, row.cpu_original / row.cpu_clipped, row.cpu_lines,
      row.cpu_msaa_original, row.cpu_msaa_clipped);
  if (row.paper.total > 0) {
    text += fmt::format("  paper: original {}, extraction {}, stencil {}, hull {}, total {}: {} times; lines +{}\n",
                        row.paper.original, row.paper.extraction, row.paper.stencil, row.paper.coarse, row.paper.total,
                        row.paper.speed_up, row.paper.antialiasing);
  }
  return text;
}

nlohmann::ordered_json json_of(const ClipRow& row) {
  const auto spread = [](const Spread& s) {
    return nlohmann::ordered_json{{"median_ms", s.median}, {"quartiles_ms", {s.low, s.high}}};
  };
  return {{"name", row.name},
          {"faces", row.faces},
          {"hull_faces", row.hull_faces},
          {"silhouette_edges", row.silhouette_edges},
          {"stencil_triangles", row.stencil_triangles},
          {"edge_on_faces", row.edge_on_faces},
          {"original", spread(row.original)},
          {"simplified", spread(row.simplified)},
          {"clipped", spread(row.clipped)},
          {"clipped_lines", spread(row.lines)},
          {"original_msaa", spread(row.msaa_original)},
          {"clipped_msaa", spread(row.msaa_clipped)},
          {"original_cpu_ms", row.cpu_original},
          {"simplified_cpu_ms", row.cpu_simplified},
          {"clipped_cpu_ms", row.cpu_clipped},
          {"clipped_lines_cpu_ms", row.cpu_lines},
          {"original_msaa_cpu_ms", row.cpu_msaa_original},
          {"clipped_msaa_cpu_ms", row.cpu_msaa_clipped},
          {"extraction_ms", row.extraction},
          {"loops_ms", row.loops},
          {"stencil_ms", row.stencil},
          {"hull_ms", row.hull},
          {"speed_up", row.original.median / row.clipped.median},
          {"paper_speed_up", row.paper.speed_up}};
}

Result<void> run_table(Bench& bench, const SubjectName& about) {
  const auto subject = make_subject(about, bench.arguments->models);
  if (!subject) return tl::unexpected(subject.error());
  const auto row = measure_row(*bench.context, *subject, bench.arguments->frames);
  if (!row) return tl::unexpected(row.error());
  bench.rows.push_back(json_of(*row));
  if (!bench.arguments->json) fmt::print("{}", text_of(*row));
  return {};
}

Result<void> run_exact(Bench& bench, const SubjectName& about) {
  const auto counted =
      count_pixels(*bench.context, about, bench.arguments->models, bench.arguments->frames, !bench.arguments->inexact);
  if (!counted) return tl::unexpected(counted.error());
  bench.rows.push_back({{"name", about.name},
                        {"pictures", counted->pictures},
                        {"covered", counted->covered},
                        {"differing", counted->differing},
                        {"pictures_differing", counted->pictures_differing}});
  if (bench.arguments->json) return {};
  fmt::print("{}: {} pixels differ in {} of {} pictures ({} pixels covered)\n", about.name, counted->differing,
             counted->pictures_differing, counted->pictures, counted->covered);
  for (const std::string& line : counted->lines)
    fmt::print("  {}\n", line);
  return {};
}

Result<void> run_figure(Bench& bench, const SubjectName& about) {
  const auto figure = measure_figure(*bench.context, about, bench.arguments->models, bench.arguments->frames);
  if (!figure) return tl::unexpected(figure.error());
  bench.figures.push_back(*figure);
  const std::pair<const char*, const std::vector<FigurePoint>*> ways[] = {
      {"simplified", &figure->simplified},
      {"clipped", &figure->clipped},
      {"clipped to simplified", &figure->clipped_simplified}};
  for (const auto& [name, points] : ways) {
    for (const FigurePoint& point : *points) {
      bench.rows.push_back(
          {{"name", about.name}, {"way", name}, {"faces", point.faces}, {"ms", point.ms}, {"mean_px", point.mean_px}});
      if (!bench.arguments->json)
        fmt::print("{:24} {:22} {:8} faces {:8.3f} ms {:8.4f} px\n", about.name, name, point.faces, point.ms,
                   point.mean_px);
    }
  }
  return {};
}

int complain(const std::string& what, const Error& error) {
  fmt::print(stderr, "clip: {}{}\n", what, format_error(error));
  return error.code == ErrorCode::kNoGraphics ? 6 : 1;
}

int run(const Arguments& arguments) {
  const auto context = gl::Context::create();
  if (!context) return complain("", context.error());
  Bench bench{&arguments, context->get(), nlohmann::ordered_json::array(), {}};
  if (!arguments.json)
    fmt::print("{}, OpenGL {}, {} threads, {} px\n", (*context)->renderer(), (*context)->version(), thread_count(),
               arguments.frames.size_px);
  int status = 0;
  for (const SubjectName& about : table_subjects()) {
    const bool asked = std::find(arguments.only.begin(), arguments.only.end(), about.name) != arguments.only.end();
    if (!arguments.only.empty() && !asked) continue;
    const auto experiment = arguments.figure                       ? run_figure
                            : arguments.exact || arguments.inexact ? run_exact
                                                                   : run_table;
    if (const Result<void> done = experiment(bench, about); !done) status = complain(about.name + ": ", done.error());
  }
  if (arguments.json) {
    const nlohmann::ordered_json data = {{"renderer", (*context)->renderer()},  {"threads", thread_count()},
                                         {"size_px", arguments.frames.size_px}, {"views", arguments.frames.views},
                                         {"seed", arguments.frames.seed},       {"rows", bench.rows}};
    fmt::print("{}\n", data.dump(2));
  }
  if (arguments.svg.empty() || bench.figures.empty()) return status;
  const auto written = write_file(arguments.svg, figure_svg(bench.figures));
  return written ? status : complain("", written.error());
}

}  // namespace
}  // namespace limn::bench

int main(int argc, char** argv) {
  limn::bench::Arguments arguments;
  CLI::App app("Measures silhouette clipping.");
  app.add_option("--only", arguments.only, "Models, as the table names them");
  app.add_option("--models", arguments.models, "Folder with the models (scripts/models)")->capture_default_str();
  app.add_option("--size", arguments.frames.size_px, "Width and height in pixels")->capture_default_str();
  app.add_option("--views", arguments.frames.views, "Random views")->capture_default_str();
  app.add_option("--seed", arguments.frames.seed, "Of the views")->capture_default_str();
  app.add_flag("--exact", arguments.exact, "Count pixels that differ from the original's");
  app.add_flag("--inexact", arguments.inexact, "The same without the faces seen edge on");
  app.add_flag("--figure", arguments.figure, "Time against outline error");
  app.add_option("--svg", arguments.svg, "Draw that into this file");
  app.add_flag("--json", arguments.json, "JSON instead of text");
  CLI11_PARSE(app, argc, argv);
  return limn::bench::run(arguments);
}
