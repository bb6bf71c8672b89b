#include <fmt/format.h>
#include <functional>
#include <utility>

#include "limn/compare/outline.h"
#include "limn/mesh/shapes.h"
#include "limn/refine/refine.h"

#include "refinement_rows.h"

namespace limn::bench {
namespace {

constexpr std::size_t kCoarseFaces = 2000, kDenseFaces = 300'000;
constexpr int kLevel = 3;

/// Mean outline error and triangles over the views.
struct Outcome {
  double mean_px = 0, triangles = 0;
};

Result<Outcome> compare(const Refiner& refiner, const Mesh& reference, const LevelOptions& levels) {
  Outcome outcome;
  CompareOptions options;
  options.views = 8;
  const auto candidate = [&](const Camera& camera, int height_px) -> Result<Mesh> {
    auto refined = refiner.refine(view_of(camera, height_px), levels);
    if (!refined) return tl::unexpected(refined.error());
    outcome.triangles += static_cast<double>(refined->mesh.face_count()) / options.views;
    return std::move(refined->mesh);
  };
  const auto compared = compare_meshes(MeshForCamera(candidate), reference, options);
  if (!compared) return tl::unexpected(compared.error());
  outcome.mean_px = compared->overall.mean_px;
  return outcome;
}

Result<RefinementRow> outline_row(const ShapeInfo& shape) {
  const auto coarse = make_shape(shape.shape, {.faces = kCoarseFaces});
  const auto dense = make_shape(shape.shape, {.faces = kDenseFaces});
  if (!coarse) return tl::unexpected(coarse.error());
  if (!dense) return tl::unexpected(dense.error());
  RefinementRow row{"outline", std::string(shape.name), coarse->face_count(), {}, {}};
  const auto put = [&row](const std::string& name, const Outcome& outcome) {
    row.figures.emplace_back(name + "_mean_px", outcome.mean_px);
    row.figures.emplace_back(name + "_triangles", outcome.triangles);
  };
  for (const PatternFamily family : {PatternFamily::kNested, PatternFamily::kMinimal}) {
    const auto refiner = Refiner::create(*coarse, {.family = family});
    if (!refiner) return tl::unexpected(refiner.error());
    const auto outcome = compare(*refiner, *dense, {.max_level = kLevel});
    if (!outcome) return tl::unexpected(outcome.error());
    put(family == PatternFamily::kNested ? "nested" : "minimal", *outcome);
    if (family == PatternFamily::kMinimal) continue;
    for (int level = 0; level <= kLevel; ++level) {
      const auto uniform = compare(*refiner, *dense, {.criterion = Criterion::kUniform, .max_level = level});
      if (!uniform) return tl::unexpected(uniform.error());
      put(fmt::format("uniform_{}", level), *uniform);
    }
  }
  return row;
}

}  // namespace

Rows uniform_outline(const RefinementBench&) {
  std::vector<RefinementRow> rows;
  for (const ShapeInfo& shape : shapes()) {
    if (shape.shape != Shape::kKnot && shape.shape != Shape::kTorus && shape.shape != Shape::kHoles3) continue;
    auto row = outline_row(shape);
    if (!row) return tl::unexpected(row.error());
    rows.push_back(std::move(*row));
    fmt::print(stderr, "refinement: outline {} done\n", shape.name);
  }
  return rows;
}

}  // namespace limn::bench
