#include "limn/asset/silhouette_levels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "limn/asset/mesh_codec.h"
#include "limn/asset/surface_distance.h"
#include "limn/hull/sequence.h"
#include "limn/silhouette/facing.h"
#include "limn/silhouette/search/leaf_partition.h"

namespace limn::asset {
namespace {

constexpr std::size_t kStep = 4;
constexpr std::size_t kTimesTheHull = 2;

/// The sequence's levels that are taken, the shell first.
std::vector<int> members(const HullSequence& sequence, std::size_t hull_faces, std::size_t most) {
  std::vector<int> levels = {0};
  std::size_t wanted = sequence.faces_at(0) / kStep;
  for (; levels.size() < most && wanted >= kTimesTheHull * hull_faces; wanted /= kStep) {
    const int level = sequence.outer_level(wanted);
    if (level > levels.back()) levels.push_back(level);
  }
  return levels;
}

float rounded_up(double value) {
  const auto rounded = static_cast<float>(value);
  return rounded < value ? std::nextafter(rounded, std::numeric_limits<float>::max()) : rounded;
}

}  // namespace

std::vector<std::uint32_t> search_leaves(const Mesh& mesh) {
  const Topology topology = build_topology(mesh);
  return leaf_partition(leaf_clusters(mesh, topology, face_planes(mesh)), topology);
}

Result<std::vector<SilhouetteLevel>> silhouette_levels(const Hull& hull, std::size_t most, const Progress& progress) {
  const Result<HullSequence> sequence = HullSequence::make(hull.shell, hull.steps);
  if (!sequence) return tl::unexpected(sequence.error());
  const std::vector<int> taken = members(*sequence, hull.report.faces, most);
  std::vector<SilhouetteLevel> levels;
  std::optional<bake_detail::FaceTree> original;
  for (std::size_t i = 0; i < taken.size(); ++i) {
    if (!report(progress, "silhouettes", static_cast<double>(i) / static_cast<double>(taken.size())))
      return fail(ErrorCode::kCancelled, "building the asset was cancelled");
    SilhouetteLevel& level = levels.emplace_back();
    level.mesh = order_for_storage(sequence->mesh_at(taken[i]));
    level.leaf_of_edge = search_leaves(level.mesh);
    if (i == 0 && taken.size() > 1) original.emplace(level.mesh.positions, level.mesh.faces);
    if (i > 0) level.error = std::max(levels[i - 1].error, rounded_up(distance_from(level.mesh, *original).bound));
  }
  return levels;
}

}  // namespace limn::asset
