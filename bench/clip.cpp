// What does clipping a coarse hull to the original's silhouette cost, and are its pixels the original's?
//
//   clip [--only NAME…] [--models DIR] [--size PX] [--views N] [--seed N] [--exact] [--json] [--svg FILE]
//
// Without more: the table of Sander et al. 2000 (Table 1), contestants alternating view by view, medians with quartiles.
// --exact counts instead the pixels that differ from those the original covers. docs/clipping.md says what each means.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <fmt/format.h>
#include <fstream>

#include "limn/base/parallel.h"

#include "clip_exact.h"
#include "clip_frames.h"

namespace limn::bench {
namespace {

struct Arguments {
  std::vector<std::string> only;
  std::string models = "models";
  FrameSettings frames;
  bool exact = false, inexact = false;
};

void print_row(const ClipRow& row) {
  fmt::print("{} ({} faces, hull {}): {:.0f} silhouette edges, {:.0f} stencil triangles, {:.0f} faces edge on\n", row.name,
             row.faces, row.hull_faces, row.silhouette_edges, row.stencil_triangles, row.edge_on_faces);
  const auto line = [](const char* name, const Spread& s) {
    fmt::print("  {:24} {:8.3f} ms ({:.3f}-{:.3f})\n", name, s.median, s.low, s.high);
  };
  line("original", row.original);
  line("simplified", row.simplified);
  line("clipped", row.clipped);
  line("clipped, lines", row.lines);
  line("original, 4 samples", row.msaa_original);
  line("clipped, 4 samples", row.msaa_clipped);
  fmt::print("  stages: extraction {:.3f}, loops {:.3f}, stencil {:.3f}, hull {:.3f}\n", row.extraction, row.loops,
             row.stencil, row.hull);
  fmt::print("  speed-up {:.2f} (paper {:.1f}), with 4 samples {:.2f}; lines add {:+.3f} ms, samples {:+.3f} ms (paper {:+.1f} on {:.1f})\n",
             row.original.median / row.clipped.median, row.paper.speed_up,
             row.msaa_original.median / row.msaa_clipped.median, row.lines.median - row.clipped.median,
             row.msaa_clipped.median - row.clipped.median, row.paper.antialiasing, row.paper.total);
}

int complain(const Error& error) {
  fmt::print(stderr, "clip: {}\n", format_error(error));
  return error.code == ErrorCode::kNoGraphics ? 6 : 1;
}

int run(const Arguments& arguments) {
  const auto context = gl::Context::create();
  if (!context) return complain(context.error());
  fmt::print("{}, OpenGL {}, {} threads, {} px\n", (*context)->renderer(), (*context)->version(), thread_count(), arguments.frames.size_px);
  for (const SubjectName& about : table_subjects()) {
    if (!arguments.only.empty() &&
        std::find(arguments.only.begin(), arguments.only.end(), about.name) == arguments.only.end())
      continue;
    if (arguments.exact || arguments.inexact) {
      const auto counted = count_pixels(**context, about, arguments.models, arguments.frames, !arguments.inexact);
      if (!counted) {
        complain(counted.error());
        continue;
      }
      fmt::print("{}: {} pixels differ in {} of {} pictures ({} pixels covered)\n", about.name, counted->differing, counted->pictures_differing, counted->pictures, counted->covered);
      for (const std::string& line : counted->lines) fmt::print("  {}\n", line);
      continue;
    }
    const auto subject = make_subject(about, arguments.models);
    if (!subject) {
      complain(subject.error());
      continue;
    }
    const auto row = measure_row(**context, *subject, arguments.frames);
    if (!row) return complain(row.error());
    print_row(*row);
  }
  return 0;
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
  CLI11_PARSE(app, argc, argv);
  return limn::bench::run(arguments);
}
