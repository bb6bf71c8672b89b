#include <cstdint>
#include <cstdlib>
#include <span>
#include <string>

#include "limn/asset/asset_file.h"
#include "limn/asset/asset_layout.h"
#include "limn/silhouette/brute.h"
#include "limn/silhouette/extractor.h"
#include "limn/silhouette/search/leaf_partition.h"

/// Reads the bytes as a clip asset, the checksum put right first, and stops the program when what comes back breaks
/// what read_clip_asset() guarantees, or when a silhouette found through its search tree is not the exact one.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace limn;
  std::string file(reinterpret_cast<const char*>(data), size);
  if (const auto at = asset::find_checksum(file))
    file.replace(*at, asset::kNoChecksum.size(), asset::checksum_of(file, *at));
  const Result<ClipAsset> read = read_clip_asset(std::as_bytes(std::span(file.data(), file.size())), "fuzz");
  if (!read) return 0;
  if (read->levels.empty() || read->hull.faces.empty()) std::abort();
  for (const SilhouetteLevel& level : read->levels) {
    for (const Triangle& face : level.mesh.faces) {
      for (const VertexId vertex : face) {
        if (vertex >= level.mesh.positions.size()) std::abort();
      }
    }
    if (level.leaf_of_edge.empty()) continue;
    const Topology topology = build_topology(level.mesh);
    const std::vector<Plane> planes = face_planes(level.mesh);
    const auto clusters = partition_clusters(level.leaf_of_edge, topology);
    if (!clusters) std::abort();
    const SilhouetteExtractor tree(level.mesh, topology, planes, SearchMethod::kTree, *clusters);
    const Eye eye{Vec3(0.7f, 1.9f, -2.3f)};
    std::vector<EdgeId> exact;
    extract_silhouette_brute(topology, planes, eye, exact);
    if (tree.find_sorted(eye) != exact) std::abort();
  }
  return 0;
}
