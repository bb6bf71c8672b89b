/// How long does a frame of an orbit take, beside a whole search of the tree? Half a degree a frame, three bounding
/// radii from the middle; whole turns of each alternate.
///
///   bench_moving [--rounds N] [--json]
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <numbers>
#include <string_view>
#include <vector>

#include "limn/mesh/shapes.h"
#include "limn/silhouette/search/edge_clusters.h"
#include "limn/silhouette/search/moving_silhouette.h"

namespace {

using namespace limn;

constexpr int kFrames = 720;

struct Options {
  int rounds = 5;
  bool json = false;
};

struct Row {
  std::string_view shape;
  std::size_t faces = 0;
  double edges = 0;  ///< in the mean
  double median_us = 0, mean_us = 0, worst_us = 0, full_us = 0;
  double leaves_median = 0, leaves_mean = 0, changed = 0;
};

std::vector<Eye> orbit(const Mesh& mesh) {
  const Bounds bounds = face_bounds(mesh);
  const Vec3 middle = 0.5f * (bounds.low + bounds.high);
  float radius = 0.0f;
  for (const Vec3& position : mesh.positions)
    radius = std::max(radius, glm::length(position - middle));
  std::vector<Eye> eyes;
  for (int i = 0; i < kFrames; ++i) {
    const float angle = 2.0f * std::numbers::pi_v<float> * static_cast<float>(i) / kFrames;
    eyes.push_back({middle + 3.0f * radius * Vec3(0.95f * std::cos(angle), 0.31225f, 0.95f * std::sin(angle))});
  }
  return eyes;
}

template <class Work>
double time_us(Work&& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values)
    sum += value;
  return sum / static_cast<double>(values.size());
}

Row measure(std::string_view name, Shape shape, std::size_t faces, int rounds) {
  const Mesh mesh = *make_shape(shape, {.faces = faces});
  const Topology topology = build_topology(mesh);
  const std::vector<Plane> planes = face_planes(mesh);
  const SearchTree tree(leaf_clusters(mesh, topology, planes), planes, quantized_frame(mesh, planes));
  const std::vector<Eye> eyes = orbit(mesh);
  MovingSilhouette moving(tree);
  SearchScratch scratch;
  // For each frame the median over the rounds, so that what else the machine does is not taken for a slow frame.
  std::vector<std::vector<double>> frames(kFrames), full(kFrames);
  std::vector<double> leaves, changed, edges;
  for (int round = -1; round < rounds; ++round) {
    for (std::size_t i = 0; i < eyes.size(); ++i) {
      const double us = time_us([&] { tree.find(eyes[i], scratch); });
      if (round >= 0) full[i].push_back(us);
    }
    for (std::size_t i = 0; i < eyes.size(); ++i) {
      std::size_t found = 0;
      const double us = time_us([&] { found = moving.find(eyes[i]).size(); });
      if (round < 0) continue;
      frames[i].push_back(us);
      leaves.push_back(static_cast<double>(moving.counters().leaves_tested));
      changed.push_back(static_cast<double>(moving.counters().edges_changed));
      edges.push_back(static_cast<double>(found));
    }
  }
  std::vector<double> times, full_times;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    times.insert(times.end(), frames[i].begin(), frames[i].end());
    full_times.insert(full_times.end(), full[i].begin(), full[i].end());
  }
  return {name,
          mesh.faces.size(),
          mean(edges),
          median(times),
          mean(times),
          *std::max_element(times.begin(), times.end()),
          median(full_times),
          median(leaves),
          mean(leaves),
          mean(changed)};
}

void print_table(const std::vector<Row>& results) {
  fmt::print(
      "| shape | faces | edges | full µs | median µs | mean µs | worst µs | leaves median | mean | edges changed "
      "|\n|---|---|---|---|---|---|---|---|---|---|\n");
  for (const Row& r : results) {
    fmt::print("| {} | {} | {:.0f} | {:.1f} | {:.1f} | {:.1f} | {:.0f} | {:.0f} | {:.0f} | {:.0f} |\n", r.shape,
               r.faces, r.edges, r.full_us, r.median_us, r.mean_us, r.worst_us, r.leaves_median, r.leaves_mean,
               r.changed);
  }
}

void print_json(const std::vector<Row>& results) {
  fmt::print("[");
  for (std::size_t i = 0; i < results.size(); ++i) {
    const Row& r = results[i];
    fmt::print(
        "{}\n  {{\"shape\": \"{}\", \"faces\": {}, \"edges\": {:.1f}, \"full_us\": {:.2f}, \"median_us\": {:.2f}, "
        "\"mean_us\": {:.2f}, \"worst_us\": {:.2f}, \"leaves_median\": {:.0f}, \"leaves_mean\": {:.1f}, "
        "\"edges_changed\": {:.1f}}}",
        i > 0 ? "," : "", r.shape, r.faces, r.edges, r.full_us, r.median_us, r.mean_us, r.worst_us, r.leaves_median,
        r.leaves_mean, r.changed);
  }
  fmt::print("\n]\n");
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (word == "--json") {
      options.json = true;
    } else if (word == "--rounds" && i + 1 < argc && std::atoi(argv[i + 1]) > 0) {
      options.rounds = std::atoi(argv[++i]);
    } else {
      fmt::print(stderr, "usage: bench_moving [--rounds N] [--json]\n");
      return 2;
    }
  }
  std::vector<Row> results;
  for (const std::size_t faces : {100'000, 1'000'000}) {
    results.push_back(measure("knot", Shape::kKnot, faces, options.rounds));
    results.push_back(measure("asteroid", Shape::kAsteroid, faces, options.rounds));
  }
  if (options.json) {
    print_json(results);
  } else {
    print_table(results);
  }
}
