#include "extraction_dyken.h"

#include <algorithm>
#include <chrono>
#include <functional>
#include <glm/geometric.hpp>

#include "limn/base/parallel.h"
#include "limn/base/random.h"
#include "limn/mesh/shapes.h"
#include "limn/mesh/topology.h"
#include "limn/silhouette/brute.h"
#include "limn/silhouette/extractor.h"

#include "extraction_gpu.h"
#include "vtk_silhouette.h"

namespace limn::bench {
namespace {

using Clock = std::chrono::steady_clock;

double microseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::micro>(Clock::now() - start).count();
}

std::vector<Eye> viewpoints(const Mesh& mesh, const ExtractionOptions& options) {
  const Bounds bounds = face_bounds(mesh);
  const Vec3 middle = 0.5f * (bounds.low + bounds.high);
  const double radius = 0.5 * glm::length(DVec3(bounds.high) - DVec3(bounds.low));
  Random random(options.seed);
  std::vector<Eye> eyes;
  for (int v = 0; v < options.views; ++v) {
    const double distance = radius * options.radii[static_cast<std::size_t>(v) % options.radii.size()];
    eyes.push_back({middle + static_cast<float>(distance) * random.direction()});
  }
  return eyes;
}

/// Reads a buffer of that size again and again: the fastest pass in gigabytes a second.
double read_bandwidth(std::size_t bytes) {
  std::vector<std::uint64_t> buffer(std::max<std::size_t>(bytes / 8, 512) / 8 * 8, 1);
  double best = 0;
  std::uint64_t sink = 0;
  for (int pass = 0; pass < 15; ++pass) {
    const int rounds = static_cast<int>(1 + (8u << 20) / (8 * buffer.size()));
    const auto start = Clock::now();
    for (int r = 0; r < rounds; ++r) {
      std::uint64_t lanes[8] = {};
      for (std::size_t i = 0; i < buffer.size(); i += 8) {
        for (std::size_t k = 0; k < 8; ++k)
          lanes[k] += buffer[i + k];
      }
      for (const std::uint64_t lane : lanes)
        sink += lane;
      buffer[sink % buffer.size()] ^= 1;  // or the compiler would read once for all rounds
    }
    const double gb = static_cast<double>(rounds) * static_cast<double>(8 * buffer.size()) * 1e-9;
    best = std::max(best, gb / (1e-6 * microseconds_since(start)));
  }
  return best;
}

/// A contestant: finds the silhouettes of the eye; its result is compared with the oracle's.
struct Contestant {
  std::string name;
  std::function<std::span<const EdgeId>(const Eye&)> find;
  int repeats = 1;
  std::vector<double> times_us{};
};

ContestantTimes summary(const std::string& name, std::vector<double> times_us) {
  std::sort(times_us.begin(), times_us.end());
  const std::size_t n = times_us.size();
  return {name, times_us[n / 2], times_us[n / 4], times_us[3 * n / 4]};
}

std::vector<EdgeId> sorted(std::span<const EdgeId> edges) {
  std::vector<EdgeId> copy(edges.begin(), edges.end());
  std::sort(copy.begin(), copy.end());
  return copy;
}

/// All that limn offers on the CPU.
class Contestants {
 public:
  Contestants(const Mesh& mesh, const Topology& topology, std::span<const Plane> planes, int repeats) {
    const QuantizedFrame frame = quantized_frame(mesh, planes);
    exact_ = EdgeBlocks(block_clusters(mesh, topology), planes, frame, EdgeBlocks::Planes::kExact);
    const auto start = Clock::now();
    own_tree_ = SearchTree(leaf_clusters(mesh, topology, planes), planes, frame);
    build_s = 1e-6 * microseconds_since(start);
    automatic_ = std::make_unique<SilhouetteExtractor>(mesh, topology, planes);
    // One tree for all, where the automatic choice keeps one: two would push each other out of the cache.
    if (automatic_->tree().leaf_count() != 0) own_tree_ = {};
    all.push_back({"plain loop", [this, &topology, planes](const Eye& eye) {
                     extract_silhouette_brute(topology, planes, eye, plain_found_);
                     return std::span<const EdgeId>(plain_found_);
                   }});
    for (const SimdLevel level : simd_levels()) {
      const std::string simd(simd_level_name(level));
      const int turns = level == SimdLevel::kScalar ? 1 : repeats;
      all.push_back({"brute " + simd,
                     [this, level](const Eye& eye) {
                       automatic_->blocks().extract(eye, found_, level);
                       return std::span<const EdgeId>(found_);
                     },
                     turns});
      all.push_back({"brute, floats " + simd,
                     [this, level](const Eye& eye) {
                       exact_.extract(eye, found_, level);
                       return std::span<const EdgeId>(found_);
                     },
                     turns});
      all.push_back({"flat " + simd,
                     [this, level](const Eye& eye) { return tree().find_flat(eye, scratch_, nullptr, level); }, turns});
      all.push_back({"tree " + simd,
                     [this, level](const Eye& eye) { return tree().find(eye, scratch_, nullptr, level); }, turns});
    }
    all.push_back({"auto", [this](const Eye& eye) { return automatic_->find(eye, scratch_); }, repeats});
  }

  const SearchTree& tree() const { return own_tree_.leaf_count() != 0 ? own_tree_ : automatic_->tree(); }
  const EdgeBlocks& blocks() const { return automatic_->blocks(); }
  const EdgeBlocks& exact() const { return exact_; }

  std::vector<Contestant> all;
  double build_s = 0;

 private:
  EdgeBlocks exact_;
  SearchTree own_tree_;
  std::unique_ptr<SilhouetteExtractor> automatic_;
  SearchScratch scratch_;
  std::vector<EdgeId> found_, plain_found_;
};

void take_turn(Contestant& contestant, const Eye& eye, std::span<const EdgeId> oracle, ExtractionRow& row) {
  double best = 1e300;
  for (int i = 0; i < contestant.repeats; ++i) {
    const auto start = Clock::now();
    const std::span<const EdgeId> found = contestant.find(eye);
    best = std::min(best, microseconds_since(start));
    if (i == 0 && sorted(found) != sorted(oracle)) ++row.mismatches;
  }
  contestant.times_us.push_back(best);
}

void add_gpu(const Topology& topology, std::span<const Plane> planes, std::span<const Eye> eyes, ExtractionRow& row) {
  const Result<GpuExtractionTimes> gpu = time_gpu_extraction(topology, planes, eyes);
  if (!gpu) return;
  const auto add = [&](const std::string& name, double ms) {
    row.contestants.push_back({name, 1e3 * ms, 1e3 * ms, 1e3 * ms});
  };
  add("gpu pyramid, read back", gpu->pyramid.read_back_ms);
  add("gpu scan, read back", gpu->scan.read_back_ms);
}

}  // namespace

std::optional<double> ExtractionRow::median_us(const std::string& wanted) const {
  for (const ContestantTimes& contestant : contestants) {
    if (contestant.name == wanted) return contestant.median_us;
  }
  return std::nullopt;
}

ExtractionRow measure_extraction(const std::string& name, const Mesh& mesh, const ExtractionOptions& options) {
  ExtractionRow row;
  row.name = name;
  const Topology topology = build_topology(mesh);
  const std::vector<Plane> planes = face_planes(mesh);
  Contestants contestants(mesh, topology, planes, options.repeats);
  std::optional<VtkSilhouette> vtk = options.vtk ? VtkSilhouette::start(mesh, topology) : std::nullopt;
  const ThreadLimit limit(options.threads);
  const double edges = static_cast<double>(contestants.tree().edge_count());
  row.faces = topology.face_count();
  row.edges = contestants.tree().edge_count();
  row.build_s = contestants.build_s;
  row.tree_bytes = static_cast<double>(contestants.tree().memory_bytes()) / edges;
  row.swept_bytes = static_cast<double>(contestants.blocks().swept_bytes()) / edges;
  row.exact_bytes = static_cast<double>(contestants.exact().swept_bytes()) / edges;
  row.read_gb_s = read_bandwidth(contestants.blocks().swept_bytes());
  row.floor_ns = row.swept_bytes / row.read_gb_s;
  row.exact_floor_ns = row.exact_bytes / read_bandwidth(contestants.exact().swept_bytes());

  const std::vector<Eye> eyes = viewpoints(mesh, options);
  std::vector<double> vtk_us;
  double found = 0, lines = 0;
  SearchCounters counters;
  SearchScratch scratch;
  for (const Eye& eye : eyes) {
    const auto silhouette = contestants.tree().find(eye, scratch, &counters);
    const std::vector<EdgeId> tree_found(silhouette.begin(), silhouette.end());
    found += static_cast<double>(tree_found.size());
    std::vector<EdgeId> oracle;
    extract_silhouette_brute(topology, planes, eye, oracle);
    for (Contestant& contestant : contestants.all)
      take_turn(contestant, eye, oracle, row);
    if (!vtk) continue;
    if (const auto turn = vtk->turn(eye)) {
      vtk_us.push_back(1e3 * turn->ms);
      lines += static_cast<double>(turn->lines);
    }
  }
  for (const Contestant& contestant : contestants.all)
    row.contestants.push_back(summary(contestant.name, contestant.times_us));
  if (!vtk_us.empty()) {
    row.contestants.push_back(summary("vtkPolyDataSilhouette", vtk_us));
    row.vtk_lines_ratio = lines / found;
  }
  if (options.gpu) add_gpu(topology, planes, std::span(eyes).first(std::min<std::size_t>(eyes.size(), 9)), row);
  row.silhouette_share = found / edges / static_cast<double>(eyes.size());
  row.leaves_entered = static_cast<double>(counters.leaves_tested) / static_cast<double>(eyes.size()) /
                       static_cast<double>(contestants.tree().leaf_count());
  return row;
}

Mesh rough_adversary(std::size_t faces, std::uint64_t seed) {
  Mesh mesh = *make_shape(Shape::kSheet, {.faces = faces});
  Random random(seed);
  const float step = 2.0f / std::sqrt(static_cast<float>(faces) / 2.0f);
  for (Vec3& position : mesh.positions)
    position.y += 4.0f * step * static_cast<float>(random.uniform(-1.0, 1.0));
  return mesh;
}

}  // namespace limn::bench
