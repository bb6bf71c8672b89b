#include "limn/refine/levels.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <glm/geometric.hpp>

#include "limn/base/parallel.h"

namespace limn {
namespace {

constexpr std::size_t kGrain = 8192;

double edge_length(const Mesh& mesh, const Edge& edge) {
  return glm::length(DVec3(mesh.positions[edge.v[1]]) - DVec3(mesh.positions[edge.v[0]]));
}

DVec3 middle_of(const Mesh& mesh, const Edge& edge) {
  return 0.5 * (DVec3(mesh.positions[edge.v[0]]) + DVec3(mesh.positions[edge.v[1]]));
}

/// alpha[e] = share(e), in parallel.
std::vector<float> per_edge(const Topology& topology, const std::function<double(std::size_t)>& share) {
  std::vector<float> alpha(topology.edge_count());
  parallel_for(alpha.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e)
      alpha[e] = static_cast<float>(share(e));
  });
  return alpha;
}

std::vector<float> distance_share(const Mesh& mesh, const Topology& topology, const Eye& eye,
                                  const LevelOptions& options) {
  double near = options.near_distance;
  double far = options.far_distance;
  if (near == 0.0 && far == 0.0) {
    const double middle = glm::length(DVec3(face_bounds(mesh).center()) - DVec3(eye.at));
    near = 0.5 * middle;
    far = 2.0 * middle;
  }
  return per_edge(topology, [&, near, far](std::size_t e) {
    const double distance = glm::length(middle_of(mesh, topology.edges[e]) - DVec3(eye.at));
    if (distance <= near) return 1.0;
    return distance >= far ? 0.0 : std::log(far / distance) / std::log(far / near);
  });
}

std::vector<float> curvature_share(const Mesh& mesh, const Topology& topology) {
  const std::vector<float> curvature = gaussian_curvature(mesh, topology);
  return per_edge(topology, [&](std::size_t e) {
    const Edge& edge = topology.edges[e];
    const double mean = 0.5 * (std::abs(double{curvature[edge.v[0]]}) + std::abs(double{curvature[edge.v[1]]}));
    return std::min(1.0, std::sqrt(mean) * edge_length(mesh, edge) / double{kFullTurn_rad});
  });
}

std::vector<float> tag_share(const Mesh& mesh, const Topology& topology, int max_level) {
  return per_edge(topology, [&, max_level](std::size_t e) {
    const Edge& edge = topology.edges[e];
    const double mean = 0.5 * (double{mesh.tags[edge.v[0]]} + double{mesh.tags[edge.v[1]]});
    return max_level > 0 ? std::clamp(mean / max_level, 0.0, 1.0) : 0.0;
  });
}

/// How far, in pixels, the picture of an edge's curve may stray from that of its chord: an eighth of the largest second
/// derivative, which lies at an end. Equal to the distance itself where the curve is a parabola, above it elsewhere,
/// and quartered exactly by each halving, so that the level found from it keeps the tolerance (Filip et al. 1986).
double deviation_px(const Mesh& mesh, const Edge& edge, const EdgeCurve& curve, const View& view) {
  const DVec3 p = mesh.positions[edge.v[0]];
  const DVec3 q = mesh.positions[edge.v[1]];
  DVec3 sight = view.eye.orthographic ? DVec3(view.eye.at) : DVec3(view.eye.at) - 0.5 * (p + q);
  const double distance = glm::length(sight);
  if (!(distance > 0.0)) return HUGE_VAL;
  sight /= distance;
  DVec3 strays[2] = {DVec3(curve.c[0]) - (2.0 * p + q) / 3.0, DVec3(curve.c[1]) - (p + 2.0 * q) / 3.0};
  for (DVec3& stray : strays)
    stray -= glm::dot(stray, sight) * sight;
  const double largest =
      0.75 * std::max(glm::length(strays[1] - 2.0 * strays[0]), glm::length(strays[0] - 2.0 * strays[1]));
  return largest * double{view.pixels_per_unit} / (view.eye.orthographic ? 1.0 : distance);
}

std::vector<float> share_of(const Mesh& mesh, const Topology& topology, std::span<const Vec3> normals, const View& view,
                            const LevelOptions& options) {
  switch (options.criterion) {
    case Criterion::kSilhouette:
      return edge_silhouetteness(mesh, topology, normals, view.eye, options.wedge);
    case Criterion::kDistance:
      return distance_share(mesh, topology, view.eye, options);
    case Criterion::kCurvature:
      return curvature_share(mesh, topology);
    case Criterion::kTags:
      return tag_share(mesh, topology, options.max_level);
    case Criterion::kUniform:
      break;
  }
  return std::vector<float>(topology.edge_count(), 1.0f);
}

}  // namespace

Result<void> check_levels(const Mesh& mesh, const View& view, const LevelOptions& options) {
  const auto invalid = [](std::string message, std::string remedy) {
    return fail(ErrorCode::kInvalidArgument, std::move(message), std::move(remedy));
  };
  if (options.max_level < 0 || options.max_level > kMaxLevel) {
    return invalid(fmt::format("maximal level {} is out of range", options.max_level),
                   fmt::format("choose 0 to {}", kMaxLevel));
  }
  if (!(options.pixels >= 0.0f) || !std::isfinite(options.pixels)) {
    return invalid("the tolerance in pixels is negative or not a number", "choose 0 or more");
  }
  if (options.pixels > 0.0f && !(view.pixels_per_unit > 0.0f)) {
    return invalid("levels by pixels need the picture's size", "give the view's pixels per unit");
  }
  if (!(options.wedge.angle_rad > 0.0f && options.wedge.angle_rad < 1.5707963f)) {
    return invalid("the wedge's angle is out of range", "choose more than 0 and less than 90 degrees");
  }
  if (options.criterion == Criterion::kDistance) {
    if (view.eye.orthographic)
      return invalid("the distance criterion needs an eye at a point", "use a perspective view");
    const bool unset = options.near_distance == 0.0f && options.far_distance == 0.0f;
    if (!unset && !(0.0f < options.near_distance && options.near_distance < options.far_distance)) {
      return invalid("near and far distances are out of order", "choose 0 < near < far");
    }
  }
  if (options.criterion == Criterion::kTags &&
      std::any_of(mesh.tags.begin(), mesh.tags.end(), [](float tag) { return std::isnan(tag); })) {
    return fail(ErrorCode::kUnsuitable, "a vertex tag is not a number", "give every vertex a number");
  }
  if (options.criterion == Criterion::kTags && mesh.tags.size() != mesh.positions.size()) {
    return fail(ErrorCode::kUnsuitable, "the mesh has no vertex tags",
                "give every vertex a property 'tag' in a PLY file, or choose another criterion");
  }
  return {};
}

Result<std::vector<float>> edge_shares(const Mesh& mesh, const Topology& topology, std::span<const Vec3> face_normals,
                                       const View& view, const LevelOptions& options) {
  if (auto valid = check_levels(mesh, view, options); !valid) return tl::unexpected(valid.error());
  return share_of(mesh, topology, face_normals, view, options);
}

float quantized_level(double level) {
  return static_cast<float>(std::floor(level / double{kLevelUnit} + 0.5)) * kLevelUnit;
}

Result<std::vector<float>> edge_levels(const Mesh& mesh, const Topology& topology, std::span<const Vec3> face_normals,
                                       std::span<const EdgeCurve> curves, const View& view,
                                       const LevelOptions& options) {
  assert(face_normals.size() == topology.face_count() && curves.size() == topology.edge_count());
  const Result<std::vector<float>> shares = edge_shares(mesh, topology, face_normals, view, options);
  if (!shares) return tl::unexpected(shares.error());
  const std::vector<float>& share = *shares;
  const double max_level = options.max_level;
  return per_edge(topology, [&](std::size_t e) {
    if (options.pixels == 0.0f) return double{quantized_level(max_level * double{share[e]})};
    const double stray = deviation_px(mesh, topology.edges[e], curves[e], view);
    const double needed = stray > 0.0 ? 0.5 * std::log2(stray / double{options.pixels}) : 0.0;
    return double{quantized_level(double{share[e]} * std::clamp(needed, 0.0, max_level))};
  });
}

}  // namespace limn
