// What does refining on the graphics device cost, beside the published pipelines and the device's own tessellation?
//
//   refinement [--only NAME…] [--largest FACES] [--size PX] [--seed N] [--svg FILE] [--json]
//
// Names: figure9b and ablations (Dyken et al. 2008, section 7.2), table3 (Lenz et al. 2009), tessellation, outline;
// all unless told. A table on standard output, or JSON with --json; --svg draws the first and the third. Contestants
// alternate frame by frame; medians, with quartiles. docs/refinement-bench.md says what each means.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <fmt/format.h>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "limn/base/file.h"
#include "limn/base/parallel.h"

#include "plot.h"
#include "refinement_rows.h"

namespace limn::bench {
namespace {

struct Arguments {
  RefinementBench bench;
  std::vector<std::string> only;
  std::string svg;
  bool json = false;
  std::string command;
};

struct Experiment {
  const char* name;
  Rows (*run)(const RefinementBench&);
};
constexpr Experiment kExperiments[] = {{"figure9b", figure_9b},
                                       {"ablations", dyken_ablations},
                                       {"table3", table_3},
                                       {"tessellation", against_tessellation},
                                       {"outline", uniform_outline}};

/// How much faster than the contestant of this name, in per cent.
std::optional<double> faster_percent(const RefinementRow& row, const std::string& than, const FrameTimes& times) {
  const FrameTimes* other = row.find(than);
  if (other == nullptr || other == &times) return std::nullopt;
  return 100.0 * (other->median_ms / times.median_ms - 1.0);
}

/// What rows of an experiment are measured against.
std::string rival_of(const RefinementRow& row) {
  if (row.experiment == "table3") return "ark";
  return row.experiment == "tessellation" ? "tess" : "uniform-patterns";
}

std::string table_of(const std::vector<RefinementRow>& rows) {
  std::string text;
  for (const RefinementRow& row : rows) {
    text += fmt::format("{} {} ({} faces)\n", row.experiment, row.name, row.faces);
    for (const auto& [name, value] : row.figures)
      text += fmt::format("  {:28} {:12.6g}\n", name, value);
    const FrameTimes* rival = row.find(rival_of(row));
    for (const FrameTimes& times : row.contestants) {
      text += fmt::format("  {:24} {:9.3f} ms ({:.3f}-{:.3f}) {:10} triangles {:11} bytes", times.name, times.median_ms,
                          times.low_ms, times.high_ms, times.triangles, times.device_bytes);
      if (const auto faster = faster_percent(row, rival_of(row), times))
        text += fmt::format("  {:+8.1f} % on {}, {:.2f} of its triangles", *faster, rival->name,
                            static_cast<double>(times.triangles) / static_cast<double>(rival->triangles));
      text += '\n';
    }
  }
  return text;
}

nlohmann::ordered_json json_of(const RefinementRow& row) {
  nlohmann::ordered_json contestants = nlohmann::ordered_json::object();
  for (const FrameTimes& times : row.contestants) {
    contestants[times.name] = {{"median_ms", times.median_ms},
                               {"quartiles_ms", {times.low_ms, times.high_ms}},
                               {"triangles", times.triangles},
                               {"device_bytes", times.device_bytes}};
    if (const auto faster = faster_percent(row, rival_of(row), times))
      contestants[times.name]["faster_percent"] = *faster;
  }
  nlohmann::ordered_json data = {{"experiment", row.experiment}, {"name", row.name}, {"faces", row.faces}};
  for (const auto& [name, value] : row.figures)
    data[name] = value;
  if (!row.contestants.empty()) data["contestants"] = contestants;
  return data;
}

const char* color_of(const std::string& contestant) {
  static const std::map<std::string, const char*> kColors = {
      {"uniform-static", "#888888"}, {"uniform-patterns", "#c0a060"}, {"dyken", "#d04040"},
      {"dyken dynamic", "#e09090"},  {"patterns nested", "#2060c0"},  {"patterns", "#20a0c0"},
      {"tess", "#208040"},           {"arkfpi", "#d04040"},           {"dmr", "#906030"},
      {"suapt", "#8040a0"},          {"patterns stored", "#40a0ff"},  {"patterns held", "#003070"}};
  const auto found = kColors.find(contestant);
  return found == kColors.end() ? "#000000" : found->second;
}

/// A line a contestant through all rows of an experiment.
template <class X, class Y>
std::vector<Series> series_of(const std::vector<RefinementRow>& rows, const std::string& experiment, const X& x,
                              const Y& y) {
  std::vector<Series> all;
  for (const RefinementRow& row : rows) {
    if (row.experiment != experiment) continue;
    for (const FrameTimes& times : row.contestants) {
      auto found = std::find_if(all.begin(), all.end(), [&](const Series& s) { return s.name == times.name; });
      if (found == all.end()) found = all.insert(all.end(), Series{times.name, color_of(times.name), false, {}, {}});
      found->x.push_back(x(row));
      found->y.push_back(y(row, times));
    }
  }
  return all;
}

std::vector<Plot> plots_of(const std::vector<RefinementRow>& rows) {
  std::vector<Plot> plots;
  Plot frames{"A frame (Dyken et al. 2008, Fig. 9b)", "faces of the mesh", "ms", true, true, {}};
  frames.series = series_of(
      rows, "figure9b", [](const RefinementRow& row) { return static_cast<double>(row.faces); },
      [](const RefinementRow&, const FrameTimes& times) { return times.median_ms; });
  Plot published{"Speed over ARK (Lenz et al. 2009, Table 3)", "row of the table", "times as fast", false, true, {}};
  Series paper{"paper: arkfpi", "#d04040", true, {}, {}};
  published.series = series_of(
      rows, "table3", [](const RefinementRow& row) { return row.figure("row"); },
      [](const RefinementRow& row, const FrameTimes& times) { return row.find("ark")->median_ms / times.median_ms; });
  for (const RefinementRow& row : rows) {
    if (row.experiment != "table3") continue;
    paper.x.push_back(row.figure("row"));
    paper.y.push_back(1.0 + row.figure("paper_faster_percent") / 100.0);
  }
  if (!frames.series.empty()) plots.push_back(std::move(frames));
  if (!published.series.empty()) {
    published.series.push_back(std::move(paper));
    plots.push_back(std::move(published));
  }
  return plots;
}

/// The processor's name where the system tells it.
std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

int complain(const Error& error) {
  fmt::print(stderr, "refinement: {}\n", format_error(error));
  return error.code == ErrorCode::kNoGraphics ? 6 : 1;
}

int report(const Arguments& arguments, const std::vector<RefinementRow>& rows, const std::string& renderer,
           const std::string& version) {
  if (arguments.json) {
    nlohmann::ordered_json data = {{"command", arguments.command},
                                   {"processor", processor()},
                                   {"threads", thread_count()},
                                   {"renderer", renderer},
                                   {"opengl", version},
                                   {"size_px", arguments.bench.size_px},
                                   {"seed", arguments.bench.seed},
                                   {"rows", nlohmann::ordered_json::array()}};
    for (const RefinementRow& row : rows)
      data["rows"].push_back(json_of(row));
    fmt::print("{}\n", data.dump(2));
  } else {
    fmt::print("{}\n{} with {} threads; {}, OpenGL {}\n\n{}", arguments.command, processor(), thread_count(), renderer,
               version, table_of(rows));
  }
  const std::vector<Plot> plots = plots_of(rows);
  if (arguments.svg.empty() || plots.empty()) return 0;
  const auto written = write_file(arguments.svg, plot_svg(plots));
  return written ? 0 : complain(written.error());
}

int run(Arguments arguments) {
  const auto context = gl::Context::create();
  if (!context) return complain(context.error());
  arguments.bench.context = context->get();
  std::vector<RefinementRow> rows;
  for (const Experiment& experiment : kExperiments) {
    if (!arguments.only.empty() &&
        std::find(arguments.only.begin(), arguments.only.end(), experiment.name) == arguments.only.end())
      continue;
    auto measured = experiment.run(arguments.bench);
    if (!measured) return complain(measured.error());
    rows.insert(rows.end(), std::make_move_iterator(measured->begin()), std::make_move_iterator(measured->end()));
  }
  return report(arguments, rows, (*context)->renderer(), (*context)->version());
}

}  // namespace
}  // namespace limn::bench

int main(int argc, char** argv) {
  limn::bench::Arguments arguments;
  CLI::App app{"what refining on the graphics device costs"};
  app.add_option("--only", arguments.only)
      ->check(CLI::IsMember({"figure9b", "ablations", "table3", "tessellation", "outline"}));
  app.add_option("--largest", arguments.bench.largest, "faces of the largest mesh refined");
  app.add_option("--size", arguments.bench.size_px, "of the picture")->check(CLI::Range(16, 8192));
  app.add_option("--seed", arguments.bench.seed);
  app.add_option("--svg", arguments.svg);
  app.add_flag("--json", arguments.json);
  CLI11_PARSE(app, argc, argv);
  arguments.command = "refinement";
  for (int i = 1; i < argc; ++i)
    arguments.command += std::string(" ") + argv[i];
  return limn::bench::run(std::move(arguments));
}
