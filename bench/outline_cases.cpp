#include "outline_cases.h"

#include <algorithm>
#include <chrono>

#include "limn/mesh/import.h"
#include "limn/mesh/shapes.h"

#include "reduce.h"

namespace limn::bench {
namespace {

constexpr float kRadians = 3.14159265f / 180.0f;

// What is measured of a model: the file's name, faces, crease angle, and the mean error it may have at most.
struct ModelCase {
  const char* name;
  const char* file;
  std::size_t faces;
  float crease_angle_deg;
  double limit_px;
  double limit_of_coarse;
};

constexpr ModelCase kModels[] = {
    {"bunny", "bunny.obj", 1000, 180, 0.91, 0},
    {"bunny", "bunny.obj", 2000, 180, 0.60, 0},
    {"armadillo", "armadillo.off", 1000, 180, 0, 0.8},
    {"fandisk", "fandisk.off", 1000, 20, 0, 1},
};

double milliseconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

}  // namespace

Result<std::vector<Case>> make_cases(const CaseOptions& options) {
  std::vector<Case> cases;
  Result<Mesh> knot = make_shape(Shape::kKnot, {.faces = 200'000});
  if (!knot) return tl::unexpected(knot.error());
  cases.push_back({.name = "knot", .original = std::move(*knot), .faces = 1000, .limit_of_coarse = 1.0 / 3.0});
  Result<Mesh> cube = make_shape(Shape::kCube);
  if (!cube) return tl::unexpected(cube.error());
  cases.push_back({.name = "cube", .original = std::move(*cube), .limit_of_coarse = 1});
  if (options.shapes_only) return cases;
  for (const ModelCase& model : kModels) {
    const std::filesystem::path path = options.models / model.file;
    if (!std::filesystem::exists(path)) {
      if (options.missing) options.missing->push_back(path.string() + " is not there; `make models` fetches it");
      continue;
    }
    Result<ImportedMesh> imported = read_mesh(path);
    if (!imported) return tl::unexpected(imported.error());
    cases.push_back({.name = model.name,
                     .original = std::move(imported->mesh),
                     .faces = model.faces,
                     .crease_angle_deg = model.crease_angle_deg,
                     .limit_px = model.limit_px,
                     .limit_of_coarse = model.limit_of_coarse});
  }
  return cases;
}

Mesh coarse_mesh(const Case& c) {
  return c.faces == 0 ? c.original : reduce(c.original, c.faces, c.crease_angle_deg * kRadians);
}

Result<Measured> measure_mesh(const Mesh& mesh, const Mesh& original, const CompareOptions& options) {
  const Result<Comparison> comparison = compare_meshes(mesh, original, options);
  if (!comparison) return tl::unexpected(comparison.error());
  return Measured{comparison->overall, static_cast<double>(mesh.face_count()), 0};
}

Result<Measured> measure_uniform(const Refiner& refiner, int level, const Mesh& original,
                                 const CompareOptions& options) {
  const std::vector<float> levels(refiner.topology().edge_count(), static_cast<float>(level));
  const auto start = std::chrono::steady_clock::now();
  const Result<Refinement> refined = refiner.refine_with(levels);
  const double ms = milliseconds_since(start);
  if (!refined) return tl::unexpected(refined.error());
  Result<Measured> measured = measure_mesh(refined->mesh, original, options);
  if (measured) measured->ms = ms;
  return measured;
}

Result<Measured> measure_silhouette(const Refiner& refiner, int max_level, const Mesh& original,
                                    const CompareOptions& options) {
  std::vector<double> times_ms;
  double triangles = 0;
  LevelOptions levels;
  levels.criterion = Criterion::kSilhouette;
  levels.max_level = max_level;
  const MeshForCamera refined_for = [&](const Camera& camera, int height_px) -> Result<Mesh> {
    const auto start = std::chrono::steady_clock::now();
    Result<Refinement> refined = refiner.refine(view_of(camera, height_px), levels);
    times_ms.push_back(milliseconds_since(start));
    if (!refined) return tl::unexpected(refined.error());
    triangles += static_cast<double>(refined->mesh.face_count());
    return std::move(refined->mesh);
  };
  const Result<Comparison> comparison = compare_meshes(refined_for, original, options);
  if (!comparison) return tl::unexpected(comparison.error());
  return Measured{comparison->overall, triangles / options.views, median(times_ms)};
}

}  // namespace limn::bench
