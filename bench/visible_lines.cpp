// How long do visible polylines take, stage by stage, and how often is a line taken for hidden that is not, or the
// other way round?
//
//   visible_lines [MODEL…] [--no-large] [--one-view] [--views N] [--points N] [--json]
//
// Asteroid and knot of 100k and 1M triangles and the given models, from random points at 1.2 diagonals; medians over
// the views. The oracle counts the faces in front of random points on lines, all of them in double, without tree or
// Embree. Points are left out within 1e-4 of the model's diagonal, along the line, of a change that the oracle sees.
#include "limn/silhouette/visible/visible_lines.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "limn/base/parallel.h"
#include "limn/base/random.h"
#include "limn/mesh/import.h"
#include "limn/mesh/shapes.h"
#include "limn/silhouette/brute.h"

#include "layer_oracle.h"

namespace limn::bench {
namespace {

struct Arguments {
  std::vector<std::string> models;
  bool no_large = false;
  bool one_view = false;
  int views = 9;
  int points = 4000;
  bool json = false;
};

struct Row {
  std::string name;
  std::size_t faces = 0, silhouette = 0, crossings = 0, turns = 0, piercings = 0, rays = 0, polylines = 0;
  double build_ms = 0, extract_ms = 0, chain_ms = 0, crossings_ms = 0, piercings_ms = 0, turns_ms = 0, rays_ms = 0,
         join_ms = 0, total_ms = 0;
  std::size_t tested = 0, skipped = 0, wrong = 0;
};

template <class Body>
double time_ms(const Body& body) {
  const auto start = std::chrono::steady_clock::now();
  body();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0.0 : values[values.size() / 2];
}

/// Random points on the lines against the oracle.
void check_points(const Mesh& mesh, const Topology& topology, const Eye& eye,
                  const std::vector<EdgeInterval>& intervals, int points, Random& random, Row& row) {
  if (intervals.empty() || points == 0) return;
  const LayerOracle oracle(mesh, topology, eye);
  struct Point {
    std::size_t interval;
    double t;
    int verdict = 0;  // 0 right, 1 wrong, 2 too near a change
  };
  std::vector<Point> drawn(static_cast<std::size_t>(points));
  for (Point& p : drawn) {
    p.interval = random.below(intervals.size());
    p.t = random.uniform(intervals[p.interval].begin, intervals[p.interval].end);
  }
  const double tolerance = 1e-4 * face_bounds(mesh).diagonal();
  parallel_for(drawn.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const EdgeInterval& interval = intervals[drawn[i].interval];
      const std::optional<bool> hidden = oracle.hides_around(interval.edge, drawn[i].t, tolerance);
      drawn[i].verdict = !hidden ? 2 : *hidden == interval.visible ? 1 : 0;
    }
  });
  for (const Point& p : drawn) {
    row.skipped += p.verdict == 2;
    row.wrong += p.verdict == 1;
    row.tested += p.verdict != 2;
  }
}

Result<Row> measure(const std::string& name, const Mesh& mesh, const Arguments& arguments) {
  Row row{.name = name, .faces = mesh.face_count()};
  const Topology topology = build_topology(mesh);
  const std::vector<Plane> planes = face_planes(mesh);
  std::optional<Result<VisibilityScene>> scene;
  row.build_ms = time_ms([&] { scene = VisibilityScene::build(mesh, topology, !arguments.one_view); });
  if (!*scene) return tl::unexpected(scene->error());
  const Bounds bounds = face_bounds(mesh);
  Random random(7);
  std::vector<double> extract, chain, crossings, piercings, turns, rays, join, total;
  std::vector<VisibilityReport> reports;
  std::vector<std::size_t> silhouettes, polylines;
  for (int view = 0; view < arguments.views; ++view) {
    const Eye eye{bounds.center() + random.direction() * static_cast<float>(1.2 * bounds.diagonal()), false};
    std::vector<EdgeId> edges;
    extract.push_back(time_ms([&] { extract_silhouette_brute(topology, planes, eye, edges); }));
    LineChains lines;
    std::vector<LinePiece> pieces;
    Polylines joined;
    VisibilityReport report;
    chain.push_back(time_ms([&] { lines = collect_lines(**scene, planes, eye, edges, {}); }));
    find_visibility(**scene, lines, edges, eye, false, &report);
    join.push_back(time_ms([&] {
                     pieces = find_visibility(**scene, lines, edges, eye, false, &report);
                     joined = join_pieces(mesh, lines, pieces, true);
                   }) -
                   report.crossings_ms - report.piercings_ms - report.turns_ms - report.rays_ms);
    VisibleLines all;
    total.push_back(time_ms([&] { all = visible_lines(**scene, planes, eye, edges); }));
    crossings.push_back(report.crossings_ms);
    piercings.push_back(report.piercings_ms);
    turns.push_back(report.turns_ms);
    rays.push_back(report.rays_ms);
    row.crossings += report.crossings;
    row.turns += report.turns;
    row.piercings += report.piercings;
    row.rays += report.rays;
    row.silhouette += edges.size();
    row.polylines += joined.lines.size();
    check_points(mesh, topology, eye, all.intervals, arguments.points, random, row);
  }
  const auto views = static_cast<std::size_t>(arguments.views);
  for (std::size_t* count : {&row.crossings, &row.turns, &row.piercings, &row.rays, &row.silhouette, &row.polylines})
    *count /= views;
  row.extract_ms = median(extract);
  row.chain_ms = median(chain);
  row.crossings_ms = median(crossings);
  row.piercings_ms = median(piercings);
  row.turns_ms = median(turns);
  row.rays_ms = median(rays);
  row.join_ms = median(join);
  row.total_ms = median(total);
  return row;
}

nlohmann::json to_json(const Row& r) {
  return {{"name", r.name},
          {"faces", r.faces},
          {"silhouette_edges", r.silhouette},
          {"crossings", r.crossings},
          {"turns", r.turns},
          {"piercings", r.piercings},
          {"rays", r.rays},
          {"polylines", r.polylines},
          {"scene_ms", r.build_ms},
          {"extract_brute_ms", r.extract_ms},
          {"chain_ms", r.chain_ms},
          {"crossings_ms", r.crossings_ms},
          {"piercings_ms", r.piercings_ms},
          {"turns_ms", r.turns_ms},
          {"rays_ms", r.rays_ms},
          {"join_ms", r.join_ms},
          {"visible_lines_ms", r.total_ms},
          {"oracle", {{"tested", r.tested}, {"skipped", r.skipped}, {"wrong", r.wrong}}}};
}

void print_table(const std::vector<Row>& rows) {
  fmt::print(
      "{:<20} {:>8} {:>7} {:>7} {:>6} {:>6} | {:>7} | {:>6} {:>6} {:>6} {:>6} {:>6} {:>6} | {:>6} | {:>7} {:>7} "
      "{:>5}\n",
      "model", "faces", "edges", "cross", "turns", "rays", "scene", "chain", "cross", "pierce", "turns", "rays", "join",
      "total", "tested", "skipped", "wrong");
  for (const Row& r : rows)
    fmt::print(
        "{:<20} {:>8} {:>7} {:>7} {:>6} {:>6} | {:>7.0f} | {:>6.2f} {:>6.2f} {:>6.2f} {:>6.2f} {:>6.2f} {:>6.2f} | "
        "{:>6.2f} | "
        "{:>7} {:>7} {:>5}\n",
        r.name, r.faces, r.silhouette, r.crossings, r.turns, r.rays, r.build_ms, r.chain_ms, r.crossings_ms,
        r.piercings_ms, r.turns_ms, r.rays_ms, r.join_ms, r.total_ms, r.tested, r.skipped, r.wrong);
  fmt::print("times in ms; total is visible_lines(): everything but extraction and the scene, which is built once\n");
}

Result<std::vector<Row>> measure_all(const Arguments& arguments) {
  std::vector<Row> rows;
  const auto add = [&](const std::string& name, const Result<Mesh>& mesh) -> Result<void> {
    if (!mesh) return tl::unexpected(mesh.error());
    Result<Row> row = measure(name, *mesh, arguments);
    if (!row) return tl::unexpected(row.error());
    rows.push_back(std::move(*row));
    return {};
  };
  for (const std::size_t faces : {std::size_t{100000}, std::size_t{1000000}}) {
    if (faces > 100000 && arguments.no_large) break;
    for (const auto& [shape, name] : {std::pair(Shape::kAsteroid, "asteroid"), std::pair(Shape::kKnot, "knot")}) {
      Result<void> done = add(fmt::format("{} {}k", name, faces / 1000), make_shape(shape, {.faces = faces}));
      if (!done) return tl::unexpected(done.error());
    }
  }
  for (const std::string& model : arguments.models) {
    Result<ImportedMesh> read = read_mesh(model);
    if (!read) return tl::unexpected(read.error());
    Result<void> done = add(std::filesystem::path(model).filename().string(), std::move(read->mesh));
    if (!done) return tl::unexpected(done.error());
  }
  return rows;
}

int run(int argc, char** argv) {
  Arguments arguments;
  CLI::App app{"times of visible polylines, and how often they are wrong"};
  app.add_option("model", arguments.models);
  app.add_flag("--no-large", arguments.no_large);
  app.add_flag("--one-view", arguments.one_view, "build scenes for one view: piercings are found in each view");
  app.add_option("--views", arguments.views)->check(CLI::Range(1, 10000));
  app.add_option("--points", arguments.points, "for the oracle, a view")->check(CLI::Range(0, 10000000));
  app.add_flag("--json", arguments.json);
  CLI11_PARSE(app, argc, argv);
  const Result<std::vector<Row>> rows = measure_all(arguments);
  if (!rows) {
    fmt::print(stderr, "visible_lines: {}\n", format_error(rows.error()));
    return 3;
  }
  if (!arguments.json) {
    print_table(*rows);
    return 0;
  }
  nlohmann::json report = {{"threads", thread_count()}, {"views", arguments.views}, {"rows", nlohmann::json::array()}};
  for (const Row& row : *rows)
    report["rows"].push_back(to_json(row));
  fmt::print("{}\n", report.dump(2));
  return 0;
}

}  // namespace
}  // namespace limn::bench

int main(int argc, char** argv) {
  return limn::bench::run(argc, argv);
}
