#include "extraction_sander.h"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <numeric>
#include <tuple>

#include "limn/base/bounds.h"
#include "limn/base/parallel.h"
#include "limn/base/random.h"
#include "limn/mesh/import.h"
#include "limn/mesh/shapes.h"
#include "limn/silhouette/brute.h"
#include "limn/silhouette/sander/johannsen_carter.h"

#include "reduce.h"

namespace limn::bench {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

template <class Work>
double microseconds_of(const Work& work) {
  const Clock::time_point start = Clock::now();
  work();
  return seconds_since(start) * 1e6;
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) /
         static_cast<double>(std::max<std::size_t>(1, values.size()));
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// One number a view.
struct Samples {
  std::vector<double> edges, nodes, us;

  void add(const SearchCounts& counts, double time_us) {
    edges.push_back(static_cast<double>(counts.edges));
    nodes.push_back(static_cast<double>(counts.nodes));
    us.push_back(time_us);
  }
  SearchMeasured measured() const { return {mean(edges), mean(nodes), median(us)}; }
};

struct Subject {
  const Topology& topology;
  const std::vector<Plane>& planes;
  const PaperForest& forest;
  const std::vector<JohannsenCarterBound>& bounds;
};

struct AllSamples {
  Samples forest, johannsen_carter;
  std::vector<double> brute_us, silhouette;
  std::size_t mismatches = 0;
};

/// Searches in turn from one eye. The buffers are kept from view to view, as a program that draws would.
class Contest {
 public:
  explicit Contest(const Subject& subject) : subject_(subject) {}

  void run(const Eye& eye, AllSamples& samples) {
    SearchCounts counts, other;
    const double forest_us = microseconds_of([&] { counts = extract_silhouette_forest(subject_.forest, eye, found_); });
    const double other_us = microseconds_of(
        [&] { other = extract_silhouette_johannsen_carter(subject_.forest, subject_.bounds, eye, found_other_); });
    samples.brute_us.push_back(
        microseconds_of([&] { extract_silhouette_brute(subject_.topology, subject_.planes, eye, brute_); }));
    samples.forest.add(counts, forest_us);
    samples.johannsen_carter.add(other, other_us);
    samples.silhouette.push_back(static_cast<double>(brute_.size()));
    sorted_ = found_;
    std::sort(sorted_.begin(), sorted_.end());
    std::sort(found_other_.begin(), found_other_.end());
    samples.mismatches += sorted_ != brute_ || found_other_ != brute_ ? 1 : 0;
  }

 private:
  Subject subject_;
  std::vector<EdgeId> found_, found_other_, brute_, sorted_;
};

void search_all(const Mesh& mesh, const Subject& subject, const SanderOptions& options, SanderRow& row) {
  const ThreadLimit one_thread(1);
  const Bounds bounds = bounds_of(mesh.positions);
  Contest contest(subject);
  AllSamples all;
  Random random(options.seed);
  AllSamples warm_up;
  contest.run({bounds.center() + Vec3(0, 0, static_cast<float>(bounds.diagonal())), false}, warm_up);
  for (const double radius : options.radii) {
    const std::size_t begin = all.forest.edges.size();
    for (int view = 0; view < options.views; ++view) {
      const DVec3 offset = DVec3(random.direction()) * (radius * bounds.diagonal() / 2);
      contest.run({Vec3(DVec3(bounds.center()) + offset), false}, all);
    }
    SearchMeasured here;
    for (std::size_t i = begin; i < all.forest.edges.size(); ++i) {
      here.edges += all.forest.edges[i] / options.views;
      here.nodes += all.forest.nodes[i] / options.views;
    }
    row.equivalents_by_radius.push_back(here.edge_equivalents());
  }
  row.silhouette_edges = mean(all.silhouette);
  row.forest = all.forest.measured();
  row.johannsen_carter = all.johannsen_carter.measured();
  row.brute_us = median(all.brute_us);
  row.mismatches = all.mismatches;
}

}  // namespace

Result<SanderRow> measure_sander(const std::string& name, const Mesh& mesh, const SanderOptions& options) {
  if (mesh.faces.empty()) return fail(ErrorCode::kUnsuitable, "there is no face to search", "measure another mesh");
  const Topology topology = build_topology(mesh);
  const std::vector<Plane> planes = face_planes(mesh);
  const Clock::time_point start = Clock::now();
  const Result<PaperForest> forest = build_paper_forest(mesh, topology, planes, options.forest);
  if (!forest) return tl::unexpected(forest.error());
  SanderRow row;
  row.name = name;
  row.faces = mesh.faces.size();
  row.edges = topology.edge_count();
  row.build_s = seconds_since(start);
  row.forest_nodes = forest->nodes.size();
  row.roots = forest->root_count;
  const std::vector<JohannsenCarterBound> bounds = johannsen_carter_bounds(*forest, mesh, topology);
  search_all(mesh, {topology, planes, *forest, bounds}, options, row);
  return row;
}

Result<std::vector<SanderRow>> measure_figure9(const std::string& name, const Mesh& mesh,
                                               const SanderOptions& options) {
  constexpr float kSmooth_rad = 3.14159265f;
  std::vector<SanderRow> rows;
  for (const std::size_t faces : {500u, 4000u, 20000u, 50000u}) {
    if (faces >= mesh.faces.size()) break;
    Result<SanderRow> row =
        measure_sander(fmt::format("{} {}", name, faces), reduce(mesh, faces, kSmooth_rad), options);
    if (!row) return tl::unexpected(row.error());
    rows.push_back(std::move(*row));
  }
  Result<SanderRow> whole = measure_sander(name, mesh, options);
  if (!whole) return tl::unexpected(whole.error());
  rows.push_back(std::move(*whole));
  return rows;
}

Result<std::vector<SanderRow>> measure_table2(const std::filesystem::path& models, const SanderOptions& options) {
  std::vector<SanderRow> rows;
  const std::filesystem::path bunny_file = models / "bunny.obj";
  if (std::filesystem::exists(bunny_file)) {
    const Result<ImportedMesh> bunny = read_mesh(bunny_file);
    if (!bunny) return tl::unexpected(bunny.error());
    Result<std::vector<SanderRow>> figure9 = measure_figure9("bunny", bunny->mesh, options);
    if (!figure9) return figure9;
    rows = std::move(*figure9);
  }
  const auto add = [&](const std::string& name, const Mesh& mesh) -> Result<void> {
    Result<SanderRow> row = measure_sander(name, mesh, options);
    if (!row) return tl::unexpected(row.error());
    rows.push_back(std::move(*row));
    return {};
  };
  const std::tuple<const char*, Shape, std::size_t> shapes[] = {{"knot", Shape::kKnot, 185'856},
                                                                {"holes3", Shape::kHoles3, 188'416}};
  for (const auto& [name, shape, faces] : shapes) {
    const Result<Mesh> mesh = make_shape(shape, {.faces = faces});
    if (!mesh) return tl::unexpected(mesh.error());
    if (const Result<void> added = add(name, *mesh); !added) return tl::unexpected(added.error());
  }
  for (const char* const file : {"armadillo.off", "ChineseDragon-10kv.off"}) {
    if (!std::filesystem::exists(models / file)) continue;
    const Result<ImportedMesh> model = read_mesh(models / file);
    if (!model) return tl::unexpected(model.error());
    const std::string name = std::filesystem::path(file).stem().string();
    if (const Result<void> added = add(name, model->mesh); !added) return tl::unexpected(added.error());
  }
  return rows;
}

std::string sander_table(const std::vector<SanderRow>& rows) {
  std::string text =
      fmt::format("{:<14} {:>8} {:>8} {:>7} {:>7} {:>7} {:>7} {:>8} {:>8} {:>8} {:>7} {:>8} {:>8} {:>7}\n", "model",
                  "faces", "edges", "build s", "silh.", "tested", "nodes", "equiv.", "forest us", "brute us", "speedup",
                  "JC equiv", "ratio", "differ");
  for (const SanderRow& row : rows) {
    text += fmt::format(
        "{:<14} {:>8} {:>8} {:>7.2f} {:>7.0f} {:>7.0f} {:>7.0f} {:>8.0f} {:>9.1f} {:>8.1f} {:>7.2f} "
        "{:>8.0f} {:>8.2f} {:>7}\n",
        row.name, row.faces, row.edges, row.build_s, row.silhouette_edges, row.forest.edges, row.forest.nodes,
        row.forest.edge_equivalents(), row.forest.us, row.brute_us, row.brute_us / row.forest.us,
        row.johannsen_carter.edge_equivalents(),
        row.johannsen_carter.edge_equivalents() / row.forest.edge_equivalents(), row.mismatches);
  }
  return text;
}

Plot sander_plot(const std::vector<SanderRow>& rows) {
  Series brute{.name = "brute force", .color = "#c8511b", .dashed = true, .x = {}, .y = {}};
  Series forest{.name = "anchored cones", .color = "#1f6fb4", .x = {}, .y = {}};
  for (const SanderRow& row : rows) {
    for (Series* series : {&brute, &forest})
      series->x.push_back(row.silhouette_edges);
    brute.y.push_back(row.brute_us);
    forest.y.push_back(row.forest.us);
  }
  return {.title = "Extraction by silhouette",
          .x_label = "silhouette edges, mean",
          .y_label = "microseconds, median",
          .series = {std::move(brute), std::move(forest)}};
}

}  // namespace limn::bench
