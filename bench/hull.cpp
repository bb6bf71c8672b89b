// How fast are hulls, and how tight, beside what one would use instead?
//
//   hull [--models DIR] [--rounds N] [--only NAME] [--threads N] [--json]
//
// limn's hulls, outer and inner; plain simplification by meshoptimizer, which encloses nothing; CGAL's Alpha Wrap where
// this was built with it (Debian: libcgal-dev), its alpha chosen so that about as many faces come out. The contestants
// alternate; medians, with the fastest and the slowest round. Times are processor time, from a mesh in memory.
// docs/hull.md
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <fmt/format.h>
#include <functional>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "limn/base/parallel.h"
#include "limn/base/random.h"
#include "limn/hull/progressive_hull.h"
#include "limn/hull/winding.h"
#include "limn/mesh/import.h"

#include "alpha_wrap.h"
#include "reduce.h"

namespace limn::bench {
namespace {

constexpr std::size_t kSamples = 2000;  // of the original's vertices, looked for outside
constexpr int kAlphaSteps = 8;

struct Arguments {
  std::filesystem::path models = "models";
  std::string only;
  int rounds = 5;
  int threads = 1;
  bool json = false;
  std::string command;
};

struct Goal {
  double seconds, ratio;
};

struct Task {
  const char* name;
  const char* file;
  std::size_t first_faces;  ///< the model is brought to so many first; 0: as it is
  std::size_t faces;
  std::optional<Goal> goal{};
};

const std::vector<Task> kTasks = {{"bunny", "bunny.obj", 0, 500, Goal{0.25, 1.10}},
                                  {"bunny", "bunny.obj", 0, 4000, Goal{0.25, 1.017}},
                                  {"armadillo", "armadillo.off", 0, 500, Goal{0.35, 1.32}},
                                  {"dragon", "dragon.ply", 400000, 4000, Goal{2.0, 1.106}},
                                  {"dragon", "dragon.ply", 400000, 500, Goal{2.0, 1.9}},
                                  {"elephant", "refined_elephant.off", 0, 500},
                                  {"fandisk", "fandisk_large.off", 0, 500}};

struct Contestant {
  std::string name;
  std::function<Mesh()> run;
  std::vector<double> seconds{};
  Mesh result{};
};

struct Line {
  std::string name;
  double median_s = 0, low_s = 0, high_s = 0;
  std::size_t faces = 0;
  double ratio = 0;
  double outside_percent = 0;
};

struct Row {
  Task task;
  std::size_t model_faces = 0;
  double shell_s = 0;
  HullReport report{};  ///< of limn's outer hull
  std::vector<Line> lines{};
};

/// Of this process's processors: on a machine that others use as well, wall time measures them.
template <class Body>
double seconds_of(const Body& body) {
  const std::clock_t start = std::clock();
  body();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

double volume_of(const Mesh& mesh) {
  const DVec3 middle(face_bounds(mesh).center());
  double volume = 0;
  for (const Triangle& face : mesh.faces) {
    const DVec3 a = DVec3(mesh.positions[face[0]]) - middle;
    const DVec3 b = DVec3(mesh.positions[face[1]]) - middle;
    const DVec3 c = DVec3(mesh.positions[face[2]]) - middle;
    volume += glm::dot(a, glm::cross(b, c)) / 6;
  }
  return volume;
}

/// The share of the one mesh's vertices that the other does not enclose; points on its surface count as enclosed.
double percent_outside(const Mesh& of, const Mesh& enclosing) {
  Random random(1);
  std::vector<VertexId> sample(kSamples);
  for (VertexId& v : sample) {
    const Triangle& face = of.faces[random.below(of.faces.size())];
    v = face[random.below(3)];
  }
  std::size_t outside = 0;
  for (const VertexId v : sample) {
    const auto winding = winding_number(enclosing.positions, enclosing.faces, of.positions[v]);
    outside += winding.has_value() && *winding <= 0;
  }
  return 100.0 * static_cast<double>(outside) / static_cast<double>(sample.size());
}

/// The alpha of a wrap with about so many faces, by halving on a logarithmic scale.
double alpha_for(const Mesh& mesh, std::size_t faces) {
  const double diagonal = face_bounds(mesh).diagonal();
  double coarse = diagonal / 2, fine = diagonal / 400;
  for (int i = 0; i < kAlphaSteps; ++i) {
    const double alpha = std::sqrt(coarse * fine);
    (alpha_wrap(mesh, alpha)->faces.size() > faces ? fine : coarse) = alpha;
  }
  return std::sqrt(coarse * fine);
}

Result<Mesh> load(const Task& task, const Arguments& arguments) {
  const std::filesystem::path path = arguments.models / task.file;
  if (!std::filesystem::exists(path))
    return fail(ErrorCode::kUnreadable, path.string() + " is not there", "make models fetches it");
  Result<ImportedMesh> imported = read_mesh(path);
  if (!imported) return tl::unexpected(imported.error());
  if (task.first_faces == 0) return std::move(imported->mesh);
  Mesh reduced = reduce(imported->mesh, task.first_faces, 3.2f);
  reduced.normals = {};
  return reduced;
}

Mesh hull_of(const Shell& shell, std::size_t faces, HullSide side, HullReport& report) {
  Result<Hull> hull = build_hull(Shell(shell), {.faces = faces, .side = side});
  if (!hull) return {};
  report = hull->report;
  return std::move(hull->mesh);
}

Line line_of(const Contestant& contestant, const Mesh& model, double volume) {
  std::vector<double> sorted = contestant.seconds;
  std::sort(sorted.begin(), sorted.end());
  Line line{.name = contestant.name,
            .median_s = sorted[sorted.size() / 2],
            .low_s = sorted.front(),
            .high_s = sorted.back(),
            .faces = contestant.result.faces.size(),
            .ratio = volume_of(contestant.result) / volume};
  if (contestant.result.faces.empty()) return line;
  const bool inner = contestant.name == "limn inner";
  line.outside_percent = inner ? percent_outside(contestant.result, model) : percent_outside(model, contestant.result);
  return line;
}

Result<Row> measure(const Task& task, const Mesh& model, const Arguments& arguments) {
  Row row{.task = task, .model_faces = model.faces.size()};
  Result<Shell> shell = make_shell(model);
  if (!shell) return tl::unexpected(shell.error());
  HullReport inner;
  std::vector<Contestant> contestants = {
      {"limn", [&] { return hull_of(*shell, task.faces, HullSide::kOuter, row.report); }},
      {"limn inner", [&] { return hull_of(*shell, task.faces, HullSide::kInner, inner); }},
      {"meshoptimizer", [&] { return reduce(model, task.faces, 3.2f); }}};
  if (has_alpha_wrap()) {
    const double alpha = alpha_for(model, task.faces);
    contestants.push_back({"alpha wrap", [&, alpha] { return *alpha_wrap(model, alpha); }});
  }
  std::vector<double> shell_s;
  for (int round = 0; round < arguments.rounds; ++round) {
    shell_s.push_back(seconds_of([&] { shell = make_shell(model); }));
    for (Contestant& contestant : contestants)
      contestant.seconds.push_back(seconds_of([&] { contestant.result = contestant.run(); }));
  }
  std::sort(shell_s.begin(), shell_s.end());
  row.shell_s = shell_s[shell_s.size() / 2];
  for (const Contestant& contestant : contestants)
    row.lines.push_back(line_of(contestant, model, row.report.volume_before));
  return row;
}

void print(const Row& row) {
  fmt::print("{} {} -> {} (shell {:.3f} s; cuts {}, filled {}, dropped {}, worst margin {:.3g})\n", row.task.name,
             row.model_faces, row.task.faces, row.shell_s, row.report.cuts, row.report.filled, row.report.dropped,
             row.report.worst_margin);
  for (const Line& line : row.lines) {
    fmt::print("  {:14} {:7.3f} s ({:.3f}-{:.3f}) {:6} faces  volume {:.4f}  outside {:.2f} %", line.name,
               line.median_s, line.low_s, line.high_s, line.faces, line.ratio, line.outside_percent);
    if (line.name == "limn" && row.task.goal)
      fmt::print("  goal {:.2f} s, {:.3f}", row.task.goal->seconds, row.task.goal->ratio);
    fmt::print("\n");
  }
}

nlohmann::ordered_json json_of(const Row& row) {
  nlohmann::ordered_json lines = nlohmann::ordered_json::array();
  for (const Line& line : row.lines) {
    lines.push_back({{"name", line.name},
                     {"median_s", line.median_s},
                     {"range_s", {line.low_s, line.high_s}},
                     {"faces", line.faces},
                     {"volume_ratio", line.ratio},
                     {"outside_percent", line.outside_percent}});
  }
  nlohmann::ordered_json data = {
      {"model", row.task.name},  {"faces", row.model_faces},          {"target", row.task.faces},
      {"shell_s", row.shell_s},  {"certified", row.report.certified}, {"worst_margin", row.report.worst_margin},
      {"cuts", row.report.cuts}, {"filled", row.report.filled},       {"dropped", row.report.dropped},
      {"contestants", lines}};
  if (row.task.goal) data["goal"] = {{"seconds", row.task.goal->seconds}, {"volume_ratio", row.task.goal->ratio}};
  return data;
}

int run(const Arguments& arguments) {
  const ThreadLimit limit(arguments.threads);
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  std::string loaded;
  Mesh model;
  for (const Task& task : kTasks) {
    if (!arguments.only.empty() && arguments.only != task.name) continue;
    if (loaded != task.file) {
      Result<Mesh> next = load(task, arguments);
      if (!next) {
        fmt::print(stderr, "hull: {}\n", format_error(next.error()));
        continue;
      }
      model = std::move(*next);
      loaded = task.file;
    }
    const Result<Row> row = measure(task, model, arguments);
    if (!row) {
      fmt::print(stderr, "hull: {}: {}\n", task.name, format_error(row.error()));
      return 4;
    }
    if (arguments.json) {
      rows.push_back(json_of(*row));
    } else {
      print(*row);
    }
  }
  if (arguments.json) {
    const nlohmann::ordered_json all = {
        {"command", arguments.command}, {"threads", arguments.threads}, {"rounds", arguments.rounds}, {"rows", rows}};
    fmt::print("{}\n", all.dump(2));
  }
  if (!has_alpha_wrap()) fmt::print(stderr, "hull: built without CGAL: no alpha wrap\n");
  return 0;
}

}  // namespace
}  // namespace limn::bench

int main(int argc, char** argv) {
  limn::bench::Arguments arguments;
  for (int i = 0; i < argc; ++i)
    arguments.command += (i > 0 ? " " : "") + std::string(argv[i]);
  CLI::App app("How fast are hulls, and how tight, beside what one would use instead?");
  app.add_option("--models", arguments.models);
  app.add_option("--only", arguments.only);
  app.add_option("--rounds", arguments.rounds)->check(CLI::PositiveNumber);
  app.add_option("--threads", arguments.threads)->check(CLI::PositiveNumber);
  app.add_flag("--json", arguments.json);
  CLI11_PARSE(app, argc, argv);
  return limn::bench::run(arguments);
}
