// How fast are maps baked, padding and misses included, beside Embree alone on the same rays; and how often does normal
// shooting tear the map apart where the closest point does (Sander et al. 2000, figures 4 and 5)?
//
//   bake [MODEL[:FACES]…] [--low FILE] [--size PX] [--rounds N] [--json]
//
// Without models: knot and asteroid of 100k triangles. The coarse mesh is the model's outer hull of FACES faces (500),
// or FILE. Contestants alternate within each round, each on a thread of its own; medians, and the spread from the first
// to the third quartile. What runs on one core is measured in that thread's processor time, which other programs
// disturb less; all cores by the clock.
#include "limn/bake/bake.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <time.h>
#include <vector>

#include "limn/bake/discontinuity.h"
#include "limn/base/parallel.h"
#include "limn/mesh/import.h"
#include "limn/mesh/normals.h"
#include "limn/mesh/shapes.h"

#include "bake_rays.h"
#include "coarse.h"

namespace limn::bench {
namespace {

using nlohmann::ordered_json;

constexpr std::array<double, 3> kFactors{4.0, 8.0, 16.0};

struct Arguments {
  std::vector<std::string> models;
  std::string low;
  int size = 1024;
  int rounds = 7;
  bool json = false;
};

struct Quartiles {
  double first = 0, median = 0, third = 0;
};

Quartiles quartiles(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto at = [&](std::size_t quarter) { return values[(values.size() - 1) * quarter / 4]; };
  return {at(1), at(2), at(3)};
}

/// On a new thread: a thread keeps the number of helpers that it began with.
double clock_ms(const std::function<void()>& body) {
  double time = 0;
  std::thread([&] {
    const auto start = std::chrono::steady_clock::now();
    body();
    time = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  }).join();
  return time;
}

/// Of the calling thread.
double processor_ms() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) * 1e3 + static_cast<double>(time.tv_nsec) * 1e-6;
}

/// What the body needs on one core, from where it reports first that texels are being filled if it does.
struct OneCore {
  double whole_ms = 0, texels_ms = 0;
};
OneCore one_core(const std::function<void(const Progress&)>& body) {
  OneCore time;
  std::thread([&] {
    const ThreadLimit limit(1);
    const double start = processor_ms();
    double baking = start;
    body([&](std::string_view stage, double done) {
      if (stage == "baking" && done == 0.0) baking = processor_ms();
      return true;
    });
    const double end = processor_ms();
    time = {end - start, end - baking};
  }).join();
  return time;
}

struct Row {
  std::string name;
  std::size_t high_faces = 0, low_faces = 0;
  BakeReport report;
  Quartiles whole_all, whole_one, shoot_one, closest_one, raw_one, stream_one;
  std::array<double, kFactors.size()> shoot_breaks{}, closest_breaks{};
  double millions(double ms) const { return static_cast<double>(report.samples) / ms / 1e3; }
};

Result<BakedMaps> baked(const Mesh& high, const Mesh& low, BakeMethod method, const Arguments& arguments,
                        bool positions, const Progress& progress = {}) {
  BakeOptions options;
  options.progress = progress;
  options.size_px = arguments.size;
  options.method = method;
  options.layout = BakeLayout::kTiles;
  options.maps.positions = positions;
  return bake(high, low, options);
}

Result<void> measure_breaks(const Mesh& high, const Mesh& low, const Arguments& arguments, Row& row) {
  for (const BakeMethod method : {BakeMethod::kShoot, BakeMethod::kClosest}) {
    const auto maps = baked(high, low, method, arguments, true);
    if (!maps) return tl::unexpected(maps.error());
    for (std::size_t i = 0; i < kFactors.size(); ++i) {
      const auto found = find_discontinuities(*maps, kFactors[i]);
      if (!found) return tl::unexpected(found.error());
      (method == BakeMethod::kShoot ? row.shoot_breaks : row.closest_breaks)[i] = found->share();
    }
    if (method == BakeMethod::kShoot) row.report = maps->report;
  }
  return {};
}

Result<Row> measure(const std::string& name, const Mesh& high, const Mesh& low, const Arguments& arguments) {
  Row row;
  row.name = name;
  row.high_faces = high.face_count();
  row.low_faces = low.face_count();
  if (const Result<void> done = measure_breaks(high, low, arguments, row); !done) return tl::unexpected(done.error());
  const auto laid_out = baked(high, low, BakeMethod::kShoot, arguments, false);
  const BakeRays rays(high, *laid_out);
  std::vector<double> whole_all, whole_one, shoot, closest, raw, stream;
  const auto bake_once = [&](BakeMethod method) {
    return one_core(
        [&](const Progress& progress) { static_cast<void>(baked(high, low, method, arguments, false, progress)); });
  };
  for (int round = 0; round < arguments.rounds; ++round) {
    whole_all.push_back(clock_ms([&] { static_cast<void>(baked(high, low, BakeMethod::kShoot, arguments, false)); }));
    const OneCore time = bake_once(BakeMethod::kShoot);
    whole_one.push_back(time.whole_ms);
    shoot.push_back(time.texels_ms);
    closest.push_back(bake_once(BakeMethod::kClosest).texels_ms);
    raw.push_back(one_core([&](const Progress&) { rays.cast_packets(); }).whole_ms);
    stream.push_back(one_core([&](const Progress&) { rays.cast_stream(); }).whole_ms);
  }
  row.whole_all = quartiles(whole_all);
  row.whole_one = quartiles(whole_one);
  row.shoot_one = quartiles(shoot);
  row.closest_one = quartiles(closest);
  row.raw_one = quartiles(raw);
  row.stream_one = quartiles(stream);
  return row;
}

ordered_json json_of(const Quartiles& values) {
  return {{"median", values.median}, {"first_quartile", values.first}, {"third_quartile", values.third}};
}

ordered_json json_of(const Row& row) {
  ordered_json json{{"model", row.name},
                    {"high_faces", row.high_faces},
                    {"low_faces", row.low_faces},
                    {"texels", row.report.texels},
                    {"miss_share", row.report.miss_share()},
                    {"whole_all_cores_ms", json_of(row.whole_all)},
                    {"whole_one_core_ms", json_of(row.whole_one)},
                    {"shoot_ms", json_of(row.shoot_one)},
                    {"shoot_million_texels_per_s", row.millions(row.shoot_one.median)},
                    {"closest_ms", json_of(row.closest_one)},
                    {"embree_packets_ms", json_of(row.raw_one)},
                    {"embree_stream_ms", json_of(row.stream_one)}};
  for (std::size_t i = 0; i < kFactors.size(); ++i) {
    json["breaks"].push_back(
        {{"factor", kFactors[i]}, {"shoot", row.shoot_breaks[i]}, {"closest", row.closest_breaks[i]}});
  }
  return json;
}

void print(const Row& row) {
  const auto spread = [](const Quartiles& q) {
    return fmt::format("{:.0f} ({:.0f}–{:.0f})", q.median, q.first, q.third);
  };
  fmt::print("{}: {} → {} faces, {} texels of {} px tiles, legs {}, mip levels clean up to {}\n", row.name,
             row.high_faces, row.low_faces, row.report.texels, row.report.tile_px, row.report.leg_px,
             row.report.clean_mip_level);
  fmt::print("  missed {:.3f} %, longest way {:.4g}, made ready in {:.0f} ms\n", 100 * row.report.miss_share(),
             row.report.worst_distance, row.report.build_ms);
  fmt::print("  bake(), all cores        {:>18} ms\n", spread(row.whole_all));
  fmt::print("  bake(), one core         {:>18} ms\n", spread(row.whole_one));
  fmt::print("  texels by shooting       {:>18} ms {:6.2f} M/s\n", spread(row.shoot_one),
             row.millions(row.shoot_one.median));
  fmt::print("  texels by closest point  {:>18} ms {:6.2f} M/s\n", spread(row.closest_one),
             row.millions(row.closest_one.median));
  fmt::print("  Embree alone, packets    {:>18} ms {:6.2f} M/s\n", spread(row.raw_one),
             row.millions(row.raw_one.median));
  fmt::print("  Embree alone, streams    {:>18} ms {:6.2f} M/s\n", spread(row.stream_one),
             row.millions(row.stream_one.median));
  for (std::size_t i = 0; i < kFactors.size(); ++i) {
    fmt::print("  neighbours more than {:>2.0f} steps apart: shooting {:.4f} %, closest point {:.4f} %\n", kFactors[i],
               100 * row.shoot_breaks[i], 100 * row.closest_breaks[i]);
  }
}

/// "bunny.obj:500".
std::pair<std::string, std::size_t> model_and_faces(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos) return {text, 500};
  return {text.substr(0, colon), std::strtoul(text.c_str() + colon + 1, nullptr, 10)};
}

Result<Row> run_model(const std::string& text, const Arguments& arguments) {
  const auto [path, faces] = model_and_faces(text);
  auto high = read_mesh(path);
  if (!high) return tl::unexpected(high.error());
  if (high->mesh.normals.empty())
    high->mesh.normals = crease_normals(high->mesh, build_topology(high->mesh), 1.0471976f);
  Result<Mesh> low = coarse_mesh(high->mesh, faces);
  if (!arguments.low.empty())
    low = read_mesh(arguments.low).map([](ImportedMesh&& read) { return std::move(read.mesh); });
  if (!low) return tl::unexpected(low.error());
  return measure(std::filesystem::path(path).stem().string(), high->mesh, *low, arguments);
}

Result<Row> run_shape(Shape shape, const std::string& name, const Arguments& arguments) {
  const auto high = make_shape(shape, {.faces = 100'000});
  if (!high) return tl::unexpected(high.error());
  const Result<Mesh> low = coarse_mesh(*high, 500);
  if (!low) return tl::unexpected(low.error());
  return measure(name, *high, *low, arguments);
}

int run(const Arguments& arguments) {
  std::vector<Result<Row>> rows;
  for (const std::string& model : arguments.models)
    rows.push_back(run_model(model, arguments));
  if (arguments.models.empty()) {
    rows.push_back(run_shape(Shape::kKnot, "knot", arguments));
    rows.push_back(run_shape(Shape::kAsteroid, "asteroid", arguments));
  }
  ordered_json json = ordered_json::array();
  for (const Result<Row>& row : rows) {
    if (!row) {
      fmt::print(stderr, "bake: {}\n", format_error(row.error()));
      return 1;
    }
    if (arguments.json) {
      json.push_back(json_of(*row));
    } else {
      print(*row);
    }
  }
  if (arguments.json) fmt::print("{}\n", json.dump(2));
  return 0;
}

}  // namespace
}  // namespace limn::bench

int main(int argc, char** argv) {
  limn::bench::Arguments arguments;
  CLI::App app("How fast are maps baked?");
  app.add_option("MODEL", arguments.models, "model files, each with :FACES behind it if not 500");
  app.add_option("--low", arguments.low, "coarse mesh instead of a hull");
  app.add_option("--size", arguments.size, "of the maps");
  app.add_option("--rounds", arguments.rounds, "of all contestants")->check(CLI::Range(1, 1000));
  app.add_flag("--json", arguments.json, "print JSON");
  CLI11_PARSE(app, argc, argv);
  return limn::bench::run(arguments);
}
