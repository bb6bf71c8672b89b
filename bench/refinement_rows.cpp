#include "refinement_rows.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

#include "limn/base/random.h"
#include "limn/mesh/shapes.h"
#include "limn/refine/patterns/table.h"

#include "refinement_contestants.h"

namespace limn::bench {
namespace {

constexpr int kLevel = 3;

Result<std::unique_ptr<FrameStage>> stage_of(const RefinementBench& bench, Shape shape, std::size_t faces) {
  return make_shape(shape, {.faces = faces}).and_then([&](const Mesh& mesh) {
    return FrameStage::create(*bench.context, mesh);
  });
}

FrameOptions frames(const RefinementBench& bench) {
  FrameOptions options;
  options.size_px = bench.size_px;
  return options;
}

Result<void> append(std::vector<RefinementRow>& rows, RefinementRow row, Result<std::vector<FrameTimes>> times) {
  if (!times) return tl::unexpected(times.error());
  row.contestants = std::move(*times);
  rows.push_back(std::move(row));
  fmt::print(stderr, "refinement: {} {} done\n", rows.back().experiment, rows.back().name);
  return {};
}

/// Uniformly distributed in [0, M], one an edge.
std::vector<float> random_levels(std::size_t edges, std::uint64_t seed) {
  Random random(seed);
  std::vector<float> levels(edges);
  for (float& level : levels)
    level = quantized_level(random.uniform(0.0, kLevel));
  return levels;
}

/// Whole levels, scattered by up to two around `middle`.
std::vector<float> scattered_levels(std::size_t edges, double middle, std::uint64_t seed) {
  Random random(seed);
  std::vector<float> levels(edges);
  for (float& level : levels)
    level = static_cast<float>(std::clamp(std::round(middle + random.uniform(-2.0, 2.0)), 0.0, 6.0));
  return levels;
}

std::uint64_t minimal_triangles(const PatternTable& table, const Topology& topology, const std::vector<float>& levels) {
  std::uint64_t count = 0;
  for (const auto& edges : topology.face_edges) {
    if (edges[0] == kInvalidId) continue;
    PatternConfig config;
    for (std::size_t c = 0; c < 3; ++c)
      config.sides[c] = static_cast<std::uint8_t>(levels[edges[c]]);
    count += table.ranges[choose_pattern(PatternFamily::kMinimal, config).base].triangle_count;
  }
  return count;
}

/// The middle with which scattered levels come nearest to so many triangles.
double fitting_middle(const PatternTable& table, const Topology& topology, std::uint64_t triangles,
                      std::uint64_t seed) {
  double low = -2.0, high = 8.0;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    const std::vector<float> levels = scattered_levels(topology.edge_count(), middle, seed);
    (minimal_triangles(table, topology, levels) < triangles ? low : high) = middle;
  }
  return high;
}

/// Lenz et al. 2009, Table 3: elements in and out, how much faster than ARK in per cent.
struct PublishedRow {
  std::size_t in;
  std::uint64_t out;
  double faster_percent;
};
constexpr PublishedRow kTable3[] = {
    {16, 25312, 79.2},   {16, 11006, 140.5},   {16, 8848, 191.8},   {48, 4758, 283.8},   {48, 8856, 222.0},
    {48, 16476, 289.9},  {110, 73094, 156.5},  {110, 25154, 261.5}, {110, 14154, 666.1}, {303, 1174, 3065.2},
    {303, 4363, 2065.2}, {303, 10157, 1369.6}, {303, 25226, 765.2}, {490, 1974, 3478.6}, {490, 3846, 3021.4},
    {490, 8084, 2507.1}, {490, 15170, 1607.1}, {490, 98146, 471.4}, {490, 521536, 66.7}};

/// A sphere of 2 slices (stacks - 1) faces.
Mesh sphere(std::uint32_t slices, std::uint32_t stacks) {
  Mesh mesh;
  mesh.positions = {Vec3(0, 1, 0), Vec3(0, -1, 0)};
  constexpr double kPi = 3.141592653589793;
  for (std::uint32_t row = 1; row < stacks; ++row) {
    const double polar = kPi * row / stacks;
    for (std::uint32_t s = 0; s < slices; ++s) {
      const double turn = 2.0 * kPi * s / slices;
      mesh.positions.push_back(
          Vec3(DVec3(std::sin(polar) * std::sin(turn), std::cos(polar), std::sin(polar) * std::cos(turn))));
    }
  }
  const auto at = [&](std::uint32_t row, std::uint32_t s) { return 2 + (row - 1) * slices + s % slices; };
  for (std::uint32_t s = 0; s < slices; ++s) {
    mesh.faces.push_back({0, at(1, s), at(1, s + 1)});
    for (std::uint32_t row = 1; row + 1 < stacks; ++row) {
      mesh.faces.push_back({at(row, s), at(row + 1, s), at(row + 1, s + 1)});
      mesh.faces.push_back({at(row, s), at(row + 1, s + 1), at(row, s + 1)});
    }
    mesh.faces.push_back({at(stacks - 1, s), 1, at(stacks - 1, s + 1)});
  }
  return mesh;
}

/// A mesh of as many faces as the published ones, which cannot be had: spheres for spheres and the smaller pacman, a
/// knot for the larger one and, open as an odd number of faces must be, for the jet.
Result<Mesh> stand_in(std::size_t faces) {
  if (faces == 16) return sphere(4, 3);
  if (faces == 48) return sphere(6, 5);
  if (faces == 110) return sphere(11, 6);
  auto knot = make_shape(Shape::kKnot, {.faces = faces});
  if (knot && knot->faces.size() == faces + 1) knot->faces.pop_back();
  return knot;
}

Result<void> append_published_row(const RefinementBench& bench, const PublishedRow& published,
                                  std::vector<RefinementRow>& rows) {
  const auto stage =
      stand_in(published.in).and_then([&](const Mesh& mesh) { return FrameStage::create(*bench.context, mesh); });
  if (!stage) return tl::unexpected(stage.error());
  const Topology& topology = (*stage)->refiner().topology();
  const PatternTable table = pattern_table(PatternFamily::kMinimal, 6);
  const double middle = fitting_middle(table, topology, published.out, bench.seed);
  const std::vector<float> given = scattered_levels(topology.edge_count(), middle, bench.seed);
  LevelOptions levels{.criterion = Criterion::kUniform};
  levels.max_level = static_cast<int>(*std::max_element(given.begin(), given.end()));
  RefinementRow row{"table3", fmt::format("{} to {}", published.in, published.out), topology.face_count(), {}, {}};
  row.figures = {{"row", static_cast<double>(&published - kTable3 + 1)},
                 {"paper_in", static_cast<double>(published.in)},
                 {"paper_out", static_cast<double>(published.out)},
                 {"out", static_cast<double>(minimal_triangles(table, topology, given))},
                 {"paper_faster_percent", published.faster_percent}};
  // Of what the methods have in common, filling pixels, nothing: the table is about their differences.
  Line line(**stage, levels, given);
  line.positions_only();
  for (const char* name : {"ark", "arkfpi", "suapt", "uniform-patterns", "patterns", "patterns nested",
                           "patterns stored", "patterns held", "tess"})
    line.add(name);
  // Room for the worst case at deep levels is room for hundreds of thousands of triangles a face.
  if (levels.max_level <= 4) line.add("dmr");
  FrameOptions options = frames(bench);
  options.stage = SurfaceStage::kPositions;
  options.rasterize = false;
  options.budget_s = 0.5;
  return append(rows, std::move(row), line.time(options));
}

}  // namespace

const FrameTimes* RefinementRow::find(const std::string& contestant) const {
  const auto found = std::find_if(contestants.begin(), contestants.end(),
                                  [&](const FrameTimes& times) { return times.name == contestant; });
  return found == contestants.end() ? nullptr : &*found;
}

double RefinementRow::figure(const std::string& wanted) const {
  return std::find_if(figures.begin(), figures.end(), [&](const auto& f) { return f.first == wanted; })->second;
}

Rows figure_9b(const RefinementBench& bench) {
  std::vector<RefinementRow> rows;
  for (const std::size_t faces : {200u, 1'000u, 5'000u, 20'000u, 100'000u, 300'000u, 1'000'000u}) {
    if (faces > bench.largest) break;
    const auto stage = stage_of(bench, Shape::kAsteroid, faces);
    if (!stage) return tl::unexpected(stage.error());
    Line line(**stage, {.max_level = kLevel});
    for (const char* name :
         {"uniform-static", "uniform-patterns", "dyken", "dyken dynamic", "patterns nested", "patterns", "tess"})
      line.add(name);
    const std::size_t count = (*stage)->refiner().mesh().face_count();
    if (auto done =
            append(rows, {"figure9b", fmt::format("asteroid {}", count), count, {}, {}}, line.time(frames(bench)));
        !done)
      return tl::unexpected(done.error());
  }
  return rows;
}

Rows dyken_ablations(const RefinementBench& bench) {
  std::vector<RefinementRow> rows;
  const auto stage = stage_of(bench, Shape::kAsteroid, std::min<std::size_t>(bench.largest, 5000));
  if (!stage) return tl::unexpected(stage.error());
  const std::size_t count = (*stage)->refiner().mesh().face_count();
  const std::vector<float> random = random_levels((*stage)->refiner().topology().edge_count(), bench.seed);
  for (const bool given : {false, true}) {
    Line line(**stage, {.max_level = kLevel}, given ? std::span<const float>(random) : std::span<const float>{});
    for (const char* name : {"uniform-patterns", "dyken", "dyken unblended", "dyken packed"})
      line.add(name);
    const std::string name = given ? "random levels" : "silhouette levels";
    if (auto done = append(rows, {"ablations", name, count, {}, {}}, line.time(frames(bench))); !done)
      return tl::unexpected(done.error());
  }
  return rows;
}

Rows table_3(const RefinementBench& bench) {
  std::vector<RefinementRow> rows;
  for (const PublishedRow& published : kTable3) {
    if (auto done = append_published_row(bench, published, rows); !done) return tl::unexpected(done.error());
  }
  return rows;
}

Rows against_tessellation(const RefinementBench& bench) {
  std::vector<RefinementRow> rows;
  for (const std::size_t faces : {10'000u, 100'000u}) {
    if (faces > bench.largest) break;
    const auto stage = stage_of(bench, Shape::kTorus, faces);
    if (!stage) return tl::unexpected(stage.error());
    const std::size_t count = (*stage)->refiner().mesh().face_count();
    for (const bool dense : {false, true}) {
      LevelOptions levels{.max_level = kLevel};
      if (dense) levels.criterion = Criterion::kUniform;
      for (const bool rasterize : {false, true}) {
        Line line(**stage, levels);
        if (!rasterize) line.positions_only();
        for (const char* name : {"tess", "patterns nested", "patterns", "patterns nested stored", "patterns stored"})
          line.add(name);
        FrameOptions options = frames(bench);
        options.rasterize = rasterize;
        if (!rasterize) options.stage = SurfaceStage::kPositions;
        const std::string name =
            fmt::format("{} {} {}", dense ? "dense" : "sparse", count, rasterize ? "picture" : "geometry");
        if (auto done = append(rows, {"tessellation", name, count, {}, {}}, line.time(options)); !done)
          return tl::unexpected(done.error());
      }
    }
  }
  return rows;
}

}  // namespace limn::bench
