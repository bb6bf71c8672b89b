// How far are outlines from the original's: coarse, refined everywhere, refined where the outline is?
//
//   outline_error [--models DIR] [--shapes-only] [--views N] [--size PX] [--level M] [--curve] [--svg FILE] [--creases]
//                 [--json] [--gate]
//
// A table on standard output, or JSON with --json; --svg draws the curve of error against level; --creases tries crease
// angles on coarse meshes without normals; --gate exits with 5 when a refined mesh misses its limit.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "limn/base/file.h"
#include "limn/base/parallel.h"

#include "outline_cases.h"
#include "plot.h"

namespace limn::bench {
namespace {

constexpr int kDeepest = 5;

// Vertices are snapped to 1/256 pixel, so an edge cut in two may move by half that and turn pixels it grazes.
constexpr double kResolutionPx = 0.01;
constexpr float kRadians = 3.14159265f / 180.0f;

struct Arguments {
  CaseOptions cases;
  CompareOptions compare;
  int level = 3;
  bool curve = false;
  std::string svg;
  bool creases = false;
  bool json = false;
  bool gate = false;
};

struct Row {
  std::string name;
  std::size_t coarse_faces = 0;
  std::size_t original_faces = 0;
  Measured coarse{}, uniform{}, silhouette{};
  double limit_px = 0;
};

struct Curve {
  std::string name;
  std::vector<Measured> uniform{}, silhouette{};  ///< by level, from 0
};

struct CreaseTrial {
  std::string name;
  float crease_angle_deg = 0;
  Measured coarse, silhouette;
};

struct Report {
  std::vector<Row> rows;
  std::vector<Curve> curves;
  std::vector<CreaseTrial> creases;
};

Result<Row> measure_row(const Case& c, const Refiner& refiner, const Arguments& arguments) {
  Row row{.name = c.name, .coarse_faces = refiner.mesh().face_count(), .original_faces = c.original.face_count()};
  Result<Measured> coarse = measure_mesh(refiner.mesh(), c.original, arguments.compare);
  if (!coarse) return tl::unexpected(coarse.error());
  Result<Measured> uniform = measure_uniform(refiner, arguments.level, c.original, arguments.compare);
  if (!uniform) return tl::unexpected(uniform.error());
  Result<Measured> silhouette = measure_silhouette(refiner, arguments.level, c.original, arguments.compare);
  if (!silhouette) return tl::unexpected(silhouette.error());
  row.coarse = *coarse;
  row.uniform = *uniform;
  row.silhouette = *silhouette;
  row.limit_px = c.limit_px > 0 ? c.limit_px : c.limit_of_coarse * coarse->error.mean_px + kResolutionPx;
  return row;
}

Result<Curve> measure_curve(const Case& c, const Refiner& refiner, const Arguments& arguments) {
  Curve curve{.name = c.name};
  for (int level = 0; level <= kDeepest; ++level) {
    Result<Measured> uniform = measure_uniform(refiner, level, c.original, arguments.compare);
    if (!uniform) return tl::unexpected(uniform.error());
    Result<Measured> silhouette = measure_silhouette(refiner, level, c.original, arguments.compare);
    if (!silhouette) return tl::unexpected(silhouette.error());
    curve.uniform.push_back(*uniform);
    curve.silhouette.push_back(*silhouette);
  }
  return curve;
}

// The coarse mesh as a file without normals would bring it: normals computed on it, split at several angles.
Result<std::vector<CreaseTrial>> try_creases(const Case& c, Mesh coarse, const Arguments& arguments) {
  coarse.normals = {};
  std::vector<CreaseTrial> trials;
  for (const float degrees : {0.0f, 20.0f, 30.0f, 40.0f, 45.0f, 60.0f, 75.0f, 90.0f, 120.0f, 180.0f}) {
    RefineOptions options;
    options.crease_angle_rad = degrees * kRadians;
    const Result<Refiner> refiner = Refiner::create(coarse, options);
    if (!refiner) return tl::unexpected(refiner.error());
    Result<Measured> before = measure_mesh(coarse, c.original, arguments.compare);
    if (!before) return tl::unexpected(before.error());
    Result<Measured> after = measure_silhouette(*refiner, arguments.level, c.original, arguments.compare);
    if (!after) return tl::unexpected(after.error());
    trials.push_back({c.name, degrees, *before, *after});
  }
  return trials;
}

Result<void> measure_case(const Case& c, const Arguments& arguments, Report& report) {
  const Mesh coarse = coarse_mesh(c);
  const Result<Refiner> refiner = Refiner::create(coarse);
  if (!refiner) return tl::unexpected(refiner.error());
  Result<Row> row = measure_row(c, *refiner, arguments);
  if (!row) return tl::unexpected(row.error());
  report.rows.push_back(*row);
  if (arguments.curve && c.faces == 1000 && (c.name == "knot" || c.name == "bunny")) {
    Result<Curve> curve = measure_curve(c, *refiner, arguments);
    if (!curve) return tl::unexpected(curve.error());
    report.curves.push_back(std::move(*curve));
  }
  if (arguments.creases) {
    Result<std::vector<CreaseTrial>> trials = try_creases(c, coarse, arguments);
    if (!trials) return tl::unexpected(trials.error());
    report.creases.insert(report.creases.end(), trials->begin(), trials->end());
  }
  return {};
}

void print_tables(const Report& report, const Arguments& arguments) {
  fmt::print("Outline error in pixels (mean, 95th percentile, maximum) over {} views of {} x {} pixels; M = {}\n\n",
             arguments.compare.views, arguments.compare.size_px, arguments.compare.size_px, arguments.level);
  fmt::print("{:<10} {:>7}  {:<10} {:>7} {:>7} {:>8} {:>8} {:>10} {:>8}\n", "model", "faces", "drawn", "mean", "p95",
             "max", "IoU", "triangles", "ms/view");
  for (const Row& row : report.rows) {
    const auto print_line = [&](const char* drawn, const Measured& m) {
      fmt::print("{:<10} {:>7}  {:<10} {:>7.3f} {:>7.3f} {:>8.3f} {:>8.5f} {:>10.0f} {:>8.2f}\n", row.name,
                 row.coarse_faces, drawn, m.error.mean_px, m.error.p95_px, m.error.max_px, m.error.iou, m.triangles,
                 m.ms);
    };
    print_line("coarse", row.coarse);
    print_line("uniform", row.uniform);
    print_line("silhouette", row.silhouette);
  }
  for (const Curve& curve : report.curves) {
    fmt::print("\n{}: mean error by level, and triangles a view\n{:>5} {:>9} {:>10} {:>11} {:>10}\n", curve.name,
               "level", "uniform", "triangles", "silhouette", "triangles");
    for (std::size_t i = 0; i < curve.uniform.size(); ++i) {
      fmt::print("{:>5} {:>9.3f} {:>10.0f} {:>11.3f} {:>10.0f}\n", i, curve.uniform[i].error.mean_px,
                 curve.uniform[i].triangles, curve.silhouette[i].error.mean_px, curve.silhouette[i].triangles);
    }
  }
  if (!report.creases.empty()) fmt::print("\nNormals computed on the coarse mesh, split at an angle\n");
  for (const CreaseTrial& t : report.creases) {
    fmt::print("{:<10} {:>4.0f} deg  coarse {:.3f}  silhouette {:.3f} px (p95 {:.3f})\n", t.name, t.crease_angle_deg,
               t.coarse.error.mean_px, t.silhouette.error.mean_px, t.silhouette.error.p95_px);
  }
}

nlohmann::json to_json(const Measured& m) {
  return {{"mean_px", m.error.mean_px}, {"p95_px", m.error.p95_px}, {"max_px", m.error.max_px},
          {"iou", m.error.iou},         {"triangles", m.triangles}, {"ms_per_view", m.ms}};
}

void print_json(const Report& report, const Arguments& arguments) {
  nlohmann::json out = {{"views", arguments.compare.views}, {"size_px", arguments.compare.size_px},
                        {"seed", arguments.compare.seed},   {"max_level", arguments.level},
                        {"threads", thread_count()},        {"rows", nlohmann::json::array()}};
  for (const Row& row : report.rows) {
    out["rows"].push_back({{"model", row.name},
                           {"coarse_faces", row.coarse_faces},
                           {"original_faces", row.original_faces},
                           {"limit_px", row.limit_px},
                           {"coarse", to_json(row.coarse)},
                           {"uniform", to_json(row.uniform)},
                           {"silhouette", to_json(row.silhouette)}});
  }
  for (const Curve& curve : report.curves) {
    nlohmann::json levels = nlohmann::json::array();
    for (std::size_t i = 0; i < curve.uniform.size(); ++i) {
      levels.push_back(
          {{"level", i}, {"uniform", to_json(curve.uniform[i])}, {"silhouette", to_json(curve.silhouette[i])}});
    }
    out["curves"].push_back({{"model", curve.name}, {"levels", std::move(levels)}});
  }
  for (const CreaseTrial& t : report.creases) {
    out["creases"].push_back({{"model", t.name},
                              {"crease_angle_deg", t.crease_angle_deg},
                              {"coarse", to_json(t.coarse)},
                              {"silhouette", to_json(t.silhouette)}});
  }
  fmt::print("{}\n", out.dump(2));
}

std::vector<Plot> plots_of(const Report& report, const Arguments& arguments) {
  const std::string y_label = fmt::format("mean outline error, pixels of {}", arguments.compare.size_px);
  Plot by_level{.title = "Error by level", .x_label = "level M", .y_label = y_label, .series = {}};
  Plot by_cost{
      .title = "Error by cost", .x_label = "triangles a view", .y_label = y_label, .log_x = true, .series = {}};
  const char* const colors[] = {"#1f6fb4", "#c8511b", "#2f8f4e", "#7a4fa3"};
  for (std::size_t i = 0; i < report.curves.size(); ++i) {
    const Curve& curve = report.curves[i];
    Series uniform{.name = curve.name + ", uniform", .color = colors[i % 4], .dashed = true, .x = {}, .y = {}};
    Series silhouette{.name = curve.name + ", outline", .color = colors[i % 4], .x = {}, .y = {}};
    Series uniform_cost = uniform;
    Series silhouette_cost = silhouette;
    for (std::size_t level = 0; level < curve.uniform.size(); ++level) {
      const auto add = [&](Series& to, double x, const Measured& m) {
        to.x.push_back(x);
        to.y.push_back(m.error.mean_px);
      };
      add(uniform, static_cast<double>(level), curve.uniform[level]);
      add(silhouette, static_cast<double>(level), curve.silhouette[level]);
      add(uniform_cost, curve.uniform[level].triangles, curve.uniform[level]);
      add(silhouette_cost, curve.silhouette[level].triangles, curve.silhouette[level]);
    }
    by_level.series.insert(by_level.series.end(), {std::move(uniform), std::move(silhouette)});
    by_cost.series.insert(by_cost.series.end(), {std::move(uniform_cost), std::move(silhouette_cost)});
  }
  return {by_level, by_cost};
}

// How many rows miss their limit; says which.
int count_misses(const Report& report) {
  int misses = 0;
  for (const Row& row : report.rows) {
    const double refined_px = row.silhouette.error.mean_px;
    if (refined_px <= row.limit_px) continue;
    fmt::print(stderr, "outline_error: {} at {} faces: refined {:.3f} px, wanted at most {:.3f}\n", row.name,
               row.coarse_faces, refined_px, row.limit_px);
    ++misses;
  }
  return misses;
}

int report_error(const Error& error) {
  fmt::print(stderr, "outline_error: {}\n", format_error(error));
  return 3;
}

int run(const Arguments& arguments) {
  const Result<std::vector<Case>> cases = make_cases(arguments.cases);
  if (!cases) return report_error(cases.error());
  Report report;
  for (const Case& c : *cases) {
    fmt::print(stderr, "{} at {} faces\n", c.name, c.faces == 0 ? c.original.face_count() : c.faces);
    const Result<void> measured = measure_case(c, arguments, report);
    if (!measured) return report_error(measured.error());
  }
  if (arguments.json) {
    print_json(report, arguments);
  } else {
    print_tables(report, arguments);
  }
  if (!arguments.svg.empty()) {
    const Result<void> written = write_file(arguments.svg, plot_svg(plots_of(report, arguments)));
    if (!written) return report_error(written.error());
  }
  return arguments.gate && count_misses(report) > 0 ? 5 : 0;
}

}  // namespace
}  // namespace limn::bench

int main(int argc, char** argv) {
  using namespace limn::bench;
  Arguments arguments;
  std::vector<std::string> missing;
  arguments.cases.missing = &missing;
  CLI::App app("Measures outline error: coarse, refined everywhere, refined where the outline is.");
  app.add_option("--models", arguments.cases.models, "Folder with the models (scripts/models)")->capture_default_str();
  app.add_flag("--shapes-only", arguments.cases.shapes_only, "Procedural shapes only");
  app.add_option("--views", arguments.compare.views, "Random views")->capture_default_str();
  app.add_option("--size", arguments.compare.size_px, "Width and height in pixels")->capture_default_str();
  app.add_option("--seed", arguments.compare.seed, "Of the views")->capture_default_str();
  app.add_option("--level", arguments.level, "M")->check(CLI::Range(0, limn::kMaxLevel))->capture_default_str();
  app.add_flag("--curve", arguments.curve, "Error against level, knot and bunny");
  app.add_option("--svg", arguments.svg, "Draw that curve into this file; implies --curve");
  app.add_flag("--creases", arguments.creases, "Crease angles for coarse meshes without normals");
  app.add_flag("--json", arguments.json, "JSON instead of tables");
  app.add_flag("--gate", arguments.gate, "Exit with 5 when a refined mesh misses its limit");
  CLI11_PARSE(app, argc, argv);
  arguments.curve = arguments.curve || !arguments.svg.empty();
  const int status = run(arguments);
  for (const std::string& line : missing)
    fmt::print(stderr, "outline_error: {}\n", line);
  return status;
}
