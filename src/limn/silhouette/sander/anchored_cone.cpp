#include "limn/silhouette/sander/anchored_cone.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "limn/base/linear_program.h"
#include "limn/silhouette/sander/gilbert.h"

namespace limn {
namespace {

constexpr double kLeastSine = 0.01;
constexpr double kTolerance = 1e-10;
constexpr std::size_t kMostRows = 48;
constexpr double kFarthestAnchor = 1e5;

// How much cos θ grows in a stored cone. A point in the narrower cone is sin(θ − θ') >= 2e-6·(1 − …) times its distance
// from the anchor in front of every face: that pays for kEyeError (3e-7), for the float normal (1.7e-7) and for the
// double arithmetic of culls().
constexpr double kNarrowing = 2e-6;

// Rounding of an anchor to floats, and with it the share of faces_eye()'s error that grows with the anchor's distance.
constexpr double kAnchorError = 6e-7;

/// The half-spaces of a few faces: in front of them (sign 1) or behind them (sign -1).
struct Rows {
  std::array<HalfSpace, kMostRows> half_spaces;
  std::array<std::uint32_t, kMostRows> faces;
  std::size_t count = 0;

  void add(const FaceCluster& cluster, std::size_t face, double sign) {
    const auto index = static_cast<std::uint32_t>(face);
    if (std::find(faces.begin(), faces.begin() + count, index) != faces.begin() + count) return;
    half_spaces[count] = {sign * cluster.normals[face], sign * cluster.offsets[face]};
    faces[count++] = index;
  }
};

struct Lowest {
  std::size_t face = 0;
  double side = std::numeric_limits<double>::infinity();
};

/// The face that `point` is least in front of, or for sign -1 least behind.
Lowest lowest_side(const FaceCluster& cluster, const DVec3& point, double sign) {
  const DVec3 p = sign * point;
  Lowest lowest;
  for (std::size_t f = 0; f < cluster.normals.size(); ++f) {
    const DVec3& n = cluster.normals[f];
    const double side = n.x * p.x + n.y * p.y + n.z * p.z + sign * cluster.offsets[f];
    if (side < lowest.side) lowest = {f, side};
  }
  return lowest;
}

struct Anchor {
  DVec3 point{0.0};
  DecidingFaces faces;
};

/// A point on the axis in front of every face: the anchor when the program's would be out of reach.
Anchor anchor_on_axis(const FaceCluster& cluster, const AnchoredCone& cone, double sign) {
  const Lowest lowest = lowest_side(cluster, cluster.near, sign);
  return {cluster.near + sign * std::max(0.0, -lowest.side / cone.sine) * cone.axis, {}};
}

/// The linear program over all faces, solved over few: the rows that matter are added one by one, each the face that
/// the optimum so far violates most.
Anchor lowest_anchor(const FaceCluster& cluster, const AnchoredCone& cone, double sign, Rows& rows) {
  const LinearProgramOptions options{.near = cluster.near};
  for (;;) {
    const std::span<const HalfSpace> used(rows.half_spaces.data(), rows.count);
    const LinearProgramResult result = solve_linear_program(used, sign * cone.axis, options);
    if (result.outcome != LinearProgramOutcome::kOptimal) return anchor_on_axis(cluster, cone, sign);
    const double distance = glm::length(result.point);
    if (distance > kFarthestAnchor) return anchor_on_axis(cluster, cone, sign);
    const Lowest lowest = lowest_side(cluster, result.point, sign);
    const std::size_t before = rows.count;
    if (lowest.side < -kTolerance * std::max(1.0, distance) && before < kMostRows) rows.add(cluster, lowest.face, sign);
    if (rows.count > before) continue;
    Anchor anchor{result.point, {}};
    for (int i = 0; i < result.support.count; ++i) {
      const auto at = static_cast<std::size_t>(i);
      anchor.faces.index[at] = rows.faces[result.support.index[at]];
    }
    anchor.faces.count = result.support.count;
    return anchor;
  }
}

Anchor anchor_of(const FaceCluster& cluster, const AnchoredCone& cone, double sign, std::size_t hint_begin,
                 std::size_t hint_end) {
  Rows rows;
  // The axis is a combination of these normals, which bounds the program.
  for (int i = 0; i < cone.axis_faces.count; ++i)
    rows.add(cluster, cone.axis_faces.index[static_cast<std::size_t>(i)], sign);
  for (std::size_t f = hint_begin; f < std::min(hint_end, hint_begin + 8); ++f)
    rows.add(cluster, f, sign);
  return lowest_anchor(cluster, cone, sign, rows);
}

ClosestSimplex closest_normals(const FaceCluster& cluster) {
  if (cluster.axis_end == 0) return closest_to_origin(cluster.normals);
  const ClosestSimplex first = closest_to_origin(cluster.normals.first(cluster.axis_end));
  if (first.contains_origin) return first;
  return closest_to_origin(cluster.normals, std::span(first.index).first(static_cast<std::size_t>(first.count)));
}

/// What the axis is really worth: it is the best one only up to rounding.
struct Spread {
  double least = 1.0;    ///< the least of normal·axis
  double largest = 0.0;  ///< the largest sine of an angle between a normal and the axis
};

Spread spread_about(const FaceCluster& cluster, const DVec3& axis) {
  Spread spread;
  double largest2 = 0.0;
  for (const DVec3& n : cluster.normals) {
    // By the cross product: √(1 − least²) is inaccurate for flat clusters.
    const DVec3 across = glm::cross(n, axis);
    largest2 = std::max(largest2, glm::dot(across, across));
    spread.least = std::min(spread.least, glm::dot(n, axis));
  }
  spread.largest = std::sqrt(largest2);
  return spread;
}

/// By how much the anchor must move along the axis, away from the faces, for culls() to be safe.
double outward_move(const FaceCluster& cluster, const CullingFrame& frame, const DVec3& anchor, double sign,
                    double least) {
  const double side = lowest_side(cluster, anchor, sign).side;
  const double wanted = frame.plane_error + kAnchorError * (glm::length(anchor) + 1e-3) + 1e-12;
  return std::max(0.0, (wanted - side) / (least - 2 * kAnchorError));
}

}  // namespace

AnchoredCone anchored_cone(const FaceCluster& cluster) {
  assert(!cluster.normals.empty() && cluster.normals.size() == cluster.offsets.size());
  AnchoredCone cone;
  const ClosestSimplex closest = closest_normals(cluster);
  cone.axis_faces = {closest.index, closest.count};
  const double distance = glm::length(closest.point);
  if (closest.contains_origin || distance < kLeastSine) return cone;
  cone.exists = true;
  cone.axis = closest.point / distance;
  cone.sine = std::min(distance, 1.0);
  cone.cosine = std::sqrt(1.0 - cone.sine * cone.sine);
  const Anchor front = anchor_of(cluster, cone, 1.0, cluster.axis_end, cluster.front_end);
  const Anchor back = anchor_of(cluster, cone, -1.0, cluster.front_end, cluster.back_end);
  cone.front_anchor = front.point;
  cone.front_faces = front.faces;
  cone.back_anchor = back.point;
  cone.back_faces = back.faces;
  return cone;
}

StoredCone stored_cone(const AnchoredCone& cone, const FaceCluster& cluster, const CullingFrame& frame) {
  if (!cone.exists) return {};
  const Spread spread = spread_about(cluster, cone.axis);
  if (spread.least < 0.9 * kLeastSine) return {};
  StoredCone stored;
  stored.scaled_normal = Vec3(cone.axis / (spread.largest + kNarrowing));
  const double front = outward_move(cluster, frame, cone.front_anchor, 1.0, spread.least);
  const double back = outward_move(cluster, frame, cone.back_anchor, -1.0, spread.least);
  stored.front_anchor = Vec3(cone.front_anchor + front * cone.axis);
  stored.back_anchor = Vec3(cone.back_anchor - back * cone.axis);
  const DVec3 between = DVec3(stored.front_anchor) - DVec3(stored.back_anchor);
  const double separation = glm::dot(between, DVec3(stored.scaled_normal));
  // Rounded up: that moves the back cone away from the faces.
  stored.separation = std::nextafter(static_cast<float>(separation), std::numeric_limits<float>::max());
  return stored;
}

}  // namespace limn
