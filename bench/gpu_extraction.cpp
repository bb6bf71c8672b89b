// What does it cost to extract silhouettes on this graphics device, and how is that split?
//
//   gpu_extraction [FACES…]
//
// Asteroids of so many faces (200 to 1,000,000 without numbers), 15 random eyes at three radii; milliseconds a view on
// standard output.
#include <cstdio>
#include <fmt/format.h>
#include <string>
#include <vector>

#include "limn/base/random.h"
#include "limn/mesh/shapes.h"

#include "extraction_gpu.h"

namespace limn::bench {
namespace {

std::vector<Eye> random_eyes(int count) {
  constexpr float kRadii[] = {1.5f, 3.0f, 10.0f};
  Random random(1);
  std::vector<Eye> eyes;
  for (int i = 0; i < count; ++i)
    eyes.push_back({kRadii[i % 3] * random.direction(), false});
  return eyes;
}

Result<void> print_row(std::size_t faces) {
  const Result<Mesh> mesh = make_shape(Shape::kAsteroid, {.faces = faces});
  if (!mesh) return tl::unexpected(mesh.error());
  const Topology topology = build_topology(*mesh);
  const auto times = time_gpu_extraction(topology, face_planes(*mesh), random_eyes(15));
  if (!times) return tl::unexpected(times.error());
  fmt::print("{:9} {:9} {:7.0f} {:8.1f} {:8.3f} {:8.3f} {:8.3f} {:8.3f} {:8.3f} {:8.3f} {:8.3f}  {}\n",
             mesh->face_count(), topology.edge_count(), times->edges_found, times->upload_ms, times->pyramid.device_ms,
             times->pyramid.wall_ms, times->pyramid.read_back_ms, times->scan.device_ms, times->scan.wall_ms,
             times->scan.read_back_ms, times->brute_ms, times->renderer);
  return {};
}

int run(const std::vector<std::size_t>& sizes) {
  fmt::print("    faces     edges   found   upload pyr.dev. pyr.wall pyr.read scan.dev scan.wall scan.read brute\n");
  for (const std::size_t faces : sizes) {
    const auto printed = print_row(faces);
    if (printed) continue;
    fmt::print(stderr, "gpu_extraction: {}\n", format_error(printed.error()));
    return printed.error().code == ErrorCode::kNoGraphics ? 6 : 1;
  }
  return 0;
}

}  // namespace
}  // namespace limn::bench

int main(int argc, char** argv) {
  std::vector<std::size_t> sizes;
  for (int i = 1; i < argc; ++i) {
    unsigned long long faces = 0;
    if (std::sscanf(argv[i], "%llu", &faces) != 1) {
      fmt::print(stderr, "gpu_extraction: {} is no number of faces\n", argv[i]);
      return 2;
    }
    sizes.push_back(faces);
  }
  if (sizes.empty()) sizes = {200, 1000, 5000, 20'000, 100'000, 300'000, 1'000'000};
  return limn::bench::run(sizes);
}
