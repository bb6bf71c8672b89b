// How fast are silhouettes found: by brute force, by trees, on the GPU, by what a user would pick today?
//
//   extraction [--models DIR] [--largest FACES] [--views N] [--seed N] [--threads N] [--only NAME…] [--no-vtk] [--gpu]
//              [--svg FILE] [--json]
//   extraction --sander [--models DIR] [--views N] [--svg FILE]
//
// Dyken et al. 2008, figure 9a: the asteroid from 200 to 10,000,000 faces, bunny, knot, and a rough adversary. A table
// on standard output, or JSON with --json; --svg draws time against faces.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "limn/base/file.h"
#include "limn/mesh/import.h"
#include "limn/mesh/shapes.h"
#include "limn/silhouette/search/simd/level.h"

#include "extraction_dyken.h"
#include "extraction_sander.h"
#include "plot.h"

namespace limn::bench {
namespace {

struct Arguments {
  ExtractionOptions options;
  std::string models = "models";
  std::size_t largest = 10'000'000;
  std::vector<std::string> only;
  std::string svg;
  bool json = false;
  bool sander = false;
};

bool wanted(const Arguments& arguments, const std::string& name) {
  return arguments.only.empty() ||
         std::find(arguments.only.begin(), arguments.only.end(), name) != arguments.only.end();
}

std::vector<ExtractionRow> measure(const Arguments& arguments) {
  std::vector<ExtractionRow> rows;
  const auto add = [&](const std::string& name, const Mesh& mesh) {
    ExtractionOptions options = arguments.options;
    if (mesh.face_count() > 3'000'000) options.vtk = false;  // it would need gigabytes, and half an hour
    rows.push_back(measure_extraction(name, mesh, options));
    fmt::print(stderr, "extraction: {} {} done\n", name, mesh.face_count());
  };
  const std::size_t sizes[] = {200,     1'000,   5'000,     10'000,    20'000,    50'000,
                               100'000, 300'000, 1'000'000, 3'000'000, 10'000'000};
  for (const std::size_t faces : sizes) {
    if (faces <= arguments.largest && wanted(arguments, "asteroid"))
      add("asteroid", *make_shape(Shape::kAsteroid, {.faces = faces}));
  }
  for (const std::size_t faces : {100'000, 1'000'000}) {
    if (faces > arguments.largest) continue;
    if (wanted(arguments, "knot")) add("knot", *make_shape(Shape::kKnot, {.faces = faces}));
    if (wanted(arguments, "rough")) add("rough", rough_adversary(faces, 1));
  }
  if (wanted(arguments, "bunny")) {
    if (const auto bunny = read_mesh(arguments.models + "/bunny.obj"))
      add("bunny", bunny->mesh);
    else
      fmt::print(stderr, "extraction: {}; `make models` fetches it\n", format_error(bunny.error()));
  }
  return rows;
}

std::string best_name(const std::string& method) {
  return method + " " + std::string(simd_level_name(best_simd_level()));
}

double or_zero(const std::optional<double>& value) {
  return value.value_or(0.0);
}

std::string table(const std::vector<ExtractionRow>& rows) {
  std::string text = fmt::format(
      "{:9} {:>10} {:>6} {:>6} | {:>8} {:>8} {:>8} {:>8} | {:>9} {:>9} {:>9} {:>9} | {:>6} {:>6} {:>6} {:>6} | {:>6} "
      "{:>5} | {}\n",
      "mesh", "faces", "sil %", "leaf %", "ns/edge", "floor", "floats", "floor", "brute µs", "flat µs", "tree µs",
      "auto µs", "÷float", "÷brute", "a/best", "VTK ÷", "build", "B/e", "wrong");
  for (const ExtractionRow& row : rows) {
    const double edges = static_cast<double>(row.edges);
    const double brute = or_zero(row.median_us(best_name("brute"))),
                 floats = or_zero(row.median_us(best_name("brute, floats")));
    const double flat = or_zero(row.median_us(best_name("flat"))), tree = or_zero(row.median_us(best_name("tree")));
    const double automatic = or_zero(row.median_us("auto"));
    const double best = std::min({brute, floats, flat, tree});
    text += fmt::format(
        "{:9} {:>10} {:>6.2f} {:>6.1f} | {:>8.3f} {:>8.3f} {:>8.3f} {:>8.3f} | {:>9.1f} {:>9.1f} {:>9.1f} {:>9.1f} | "
        "{:>6.1f} {:>6.1f} {:>6.2f} {:>6.0f} | {:>6.2f} {:>5.1f} | {}\n",
        row.name, row.faces, 100 * row.silhouette_share, 100 * row.leaves_entered, 1e3 * brute / edges, row.floor_ns,
        1e3 * floats / edges, row.exact_floor_ns, brute, flat, tree, automatic, floats / tree, brute / tree,
        automatic / best, or_zero(row.median_us("vtkPolyDataSilhouette")) / automatic, row.build_s, row.tree_bytes,
        row.mismatches);
  }
  text += "\nAll contestants, median µs (quartiles):\n";
  for (const ExtractionRow& row : rows) {
    text += fmt::format("{} {}:", row.name, row.faces);
    for (const ContestantTimes& times : row.contestants)
      text += fmt::format(" {} {:.1f} ({:.1f}–{:.1f});", times.name, times.median_us, times.low_us, times.high_us);
    text += fmt::format(" VTK's lines over limn's {:.4f}; {:.1f} GB/s\n", row.vtk_lines_ratio, row.read_gb_s);
  }
  return text;
}

nlohmann::ordered_json to_json(const ExtractionRow& row) {
  nlohmann::ordered_json contestants = nlohmann::ordered_json::object();
  for (const ContestantTimes& times : row.contestants)
    contestants[times.name] = {{"median_us", times.median_us}, {"quartiles_us", {times.low_us, times.high_us}}};
  return {{"name", row.name},
          {"faces", row.faces},
          {"edges", row.edges},
          {"silhouette_share", row.silhouette_share},
          {"leaves_entered", row.leaves_entered},
          {"contestants", contestants},
          {"mismatches", row.mismatches},
          {"swept_bytes_per_edge", row.swept_bytes},
          {"float_bytes_per_edge", row.exact_bytes},
          {"floor_ns_per_edge", row.floor_ns},
          {"float_floor_ns_per_edge", row.exact_floor_ns},
          {"read_gb_per_s", row.read_gb_s},
          {"build_s", row.build_s},
          {"tree_bytes_per_edge", row.tree_bytes},
          {"vtk_lines_ratio", row.vtk_lines_ratio}};
}

Plot time_plot(const std::vector<ExtractionRow>& rows) {
  Plot plot{"Silhouettes of the asteroid", "faces", "µs a view", true, true, {}};
  struct Line {
    std::string contestant, label, color;
  };
  const Line lines[] = {{"vtkPolyDataSilhouette", "VTK", "#b2182b"},
                        {"plain loop", "plain loop", "#ef8a62"},
                        {best_name("brute, floats"), "brute, floats", "#999999"},
                        {best_name("brute"), "brute", "#4d4d4d"},
                        {best_name("tree"), "tree", "#2166ac"},
                        {"gpu scan, read back", "GPU", "#762a83"}};
  for (const auto& [name, label, color] : lines) {
    Series series{label, color, false, {}, {}};
    for (const ExtractionRow& row : rows) {
      const std::optional<double> median = row.median_us(name);
      if (row.name != "asteroid" || !median) continue;
      series.x.push_back(static_cast<double>(row.faces));
      series.y.push_back(*median);
    }
    if (!series.x.empty()) plot.series.push_back(series);
  }
  return plot;
}

int run(const Arguments& arguments) {
  const std::vector<ExtractionRow> rows = measure(arguments);
  if (arguments.json) {
    nlohmann::ordered_json json = {{"simd", simd_level_name(best_simd_level())},
                                   {"threads", arguments.options.threads},
                                   {"views", arguments.options.views},
                                   {"rows", nlohmann::ordered_json::array()}};
    for (const ExtractionRow& row : rows)
      json["rows"].push_back(to_json(row));
    fmt::print("{}\n", json.dump(2));
  } else {
    fmt::print("{}", table(rows));
  }
  if (!arguments.svg.empty()) {
    if (const auto written = write_file(arguments.svg, plot_svg({time_plot(rows)})); !written) {
      fmt::print(stderr, "extraction: {}\n", format_error(written.error()));
      return 3;
    }
  }
  return std::any_of(rows.begin(), rows.end(), [](const ExtractionRow& row) { return row.mismatches != 0; }) ? 5 : 0;
}

nlohmann::ordered_json to_json(const SanderRow& row) {
  const auto search = [](const SearchMeasured& measured) {
    return nlohmann::ordered_json{{"edges", measured.edges},
                                  {"nodes", measured.nodes},
                                  {"edge_equivalents", measured.edge_equivalents()},
                                  {"us", measured.us}};
  };
  return {{"name", row.name},
          {"faces", row.faces},
          {"edges", row.edges},
          {"silhouette_edges", row.silhouette_edges},
          {"build_s", row.build_s},
          {"forest", search(row.forest)},
          {"johannsen_carter", search(row.johannsen_carter)},
          {"brute_us", row.brute_us},
          {"mismatches", row.mismatches}};
}

int run_sander(const Arguments& arguments) {
  SanderOptions options;
  options.views = arguments.options.views;
  options.seed = arguments.options.seed;
  const Result<std::vector<SanderRow>> rows = measure_table2(arguments.models, options);
  if (!rows) {
    fmt::print(stderr, "extraction: {}\n", format_error(rows.error()));
    return 3;
  }
  if (arguments.json) {
    nlohmann::ordered_json json = {{"views", options.views}, {"rows", nlohmann::ordered_json::array()}};
    for (const SanderRow& row : *rows)
      json["rows"].push_back(to_json(row));
    fmt::print("{}\n", json.dump(2));
  } else {
    fmt::print("{}", sander_table(*rows));
  }
  std::vector<SanderRow> bunnies;
  std::copy_if(rows->begin(), rows->end(), std::back_inserter(bunnies),
               [](const SanderRow& row) { return row.name.starts_with("bunny"); });
  if (!arguments.svg.empty() && !bunnies.empty()) {
    if (const auto written = write_file(arguments.svg, plot_svg({sander_plot(bunnies)})); !written) {
      fmt::print(stderr, "extraction: {}\n", format_error(written.error()));
      return 3;
    }
  }
  return std::any_of(rows->begin(), rows->end(), [](const SanderRow& row) { return row.mismatches != 0; }) ? 5 : 0;
}

}  // namespace
}  // namespace limn::bench

int main(int argc, char** argv) {
  using namespace limn::bench;
  Arguments arguments;
  bool no_vtk = false;
  CLI::App app("Times the search for silhouettes; exits with 5 when two methods differ.");
  app.add_option("--models", arguments.models, "Folder with the models (scripts/models)")->capture_default_str();
  app.add_option("--largest", arguments.largest, "Most faces")->capture_default_str();
  app.add_option("--views", arguments.options.views, "Random viewpoints, a third at each of three radii")
      ->capture_default_str();
  app.add_option("--seed", arguments.options.seed, "Of the viewpoints")->capture_default_str();
  app.add_option("--threads", arguments.options.threads, "For brute force")->capture_default_str();
  app.add_option("--only", arguments.only, "asteroid, knot, rough, bunny");
  app.add_flag("--no-vtk", no_vtk, "Without vtkPolyDataSilhouette");
  app.add_flag("--gpu", arguments.options.gpu, "With extraction on the graphics device");
  app.add_option("--svg", arguments.svg, "Draw time against faces into this file");
  app.add_flag("--sander", arguments.sander, "Table 2 and figure 9 of Sander et al. 2000");
  app.add_flag("--json", arguments.json, "JSON instead of a table");
  CLI11_PARSE(app, argc, argv);
  arguments.options.vtk = !no_vtk;
  return arguments.sander ? run_sander(arguments) : run(arguments);
}
