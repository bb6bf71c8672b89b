// Table 2 and figure 9 of Sander et al. 2000: what does their search forest test, and how long does it take?
//
//   paper_forest [--models DIR] [--views N] [--svg FILE] [--radius R] [--similar RAD]
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <string>
#include <vector>

#include "limn/base/file.h"
#include "limn/mesh/import.h"
#include "limn/mesh/shapes.h"

#include "extraction_sander.h"

namespace limn::bench {
namespace {

struct Arguments {
  std::filesystem::path models = "models";
  std::string svg;
  SanderOptions sander;
};

struct Model {
  std::string name;
  Mesh mesh;
};

/// The paper's shapes at its sizes, and what models are there.
Result<std::vector<Model>> make_models(const Arguments& arguments) {
  std::vector<Model> models;
  Result<Mesh> knot = make_shape(Shape::kKnot, {.faces = 185856});
  if (!knot) return tl::unexpected(knot.error());
  models.push_back({"knot", std::move(*knot)});
  Result<Mesh> holes3 = make_shape(Shape::kHoles3, {.faces = 188416});
  if (!holes3) return tl::unexpected(holes3.error());
  models.push_back({"holes3", std::move(*holes3)});
  for (const char* const file : {"armadillo.off", "ChineseDragon-10kv.off"}) {
    const std::filesystem::path path = arguments.models / file;
    if (!std::filesystem::exists(path)) continue;
    Result<ImportedMesh> imported = read_mesh(path);
    if (!imported) return tl::unexpected(imported.error());
    models.push_back({path.stem().string(), std::move(imported->mesh)});
  }
  return models;
}

Result<std::vector<SanderRow>> measure_bunnies(const Arguments& arguments) {
  const std::filesystem::path path = arguments.models / "bunny.obj";
  if (!std::filesystem::exists(path)) {
    fmt::print(stderr, "paper_forest: {} is missing: figure 9 is left out\n", path.string());
    return std::vector<SanderRow>();
  }
  const Result<ImportedMesh> bunny = read_mesh(path);
  if (!bunny) return tl::unexpected(bunny.error());
  return measure_figure9("bunny", bunny->mesh, arguments.sander);
}

Result<void> run(const Arguments& arguments) {
  const Result<std::vector<SanderRow>> bunnies = measure_bunnies(arguments);
  if (!bunnies) return tl::unexpected(bunnies.error());
  std::vector<SanderRow> rows = *bunnies;
  const Result<std::vector<Model>> models = make_models(arguments);
  if (!models) return tl::unexpected(models.error());
  for (const Model& model : *models) {
    Result<SanderRow> row = measure_sander(model.name, model.mesh, arguments.sander);
    if (!row) return tl::unexpected(row.error());
    rows.push_back(std::move(*row));
  }
  fmt::print("{}", sander_table(rows));
  if (arguments.svg.empty() || bunnies->empty()) return {};
  return write_file(arguments.svg, plot_svg({sander_plot(*bunnies)}));
}

}  // namespace
}  // namespace limn::bench

int main(int argc, char** argv) {
  using namespace limn::bench;
  Arguments arguments;
  CLI::App app("Measures the search forest of Sander et al. 2000: table 2 and figure 9.");
  app.add_option("--models", arguments.models, "Folder with the models (scripts/models)")->capture_default_str();
  app.add_option("--views", arguments.sander.views, "Random views at each of three radii")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  app.add_option("--radius", arguments.sander.forest.viewpoint_radius, "Of the sphere U, in radii of the mesh")
      ->capture_default_str();
  app.add_option("--similar", arguments.sander.forest.similar_normals_rad, "Links similar normals, in radians")
      ->capture_default_str();
  app.add_option("--svg", arguments.svg, "Draw figure 9 into this file");
  CLI11_PARSE(app, argc, argv);
  const limn::Result<void> done = run(arguments);
  if (done) return 0;
  fmt::print(stderr, "paper_forest: {}\n", format_error(done.error()));
  return 3;
}
