#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "limn/mesh/shapes/builders.h"
#include "limn/mesh/shapes/grid.h"

namespace limn::procedural {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

double fraction(std::size_t i, std::size_t count) {
  return static_cast<double>(i) / static_cast<double>(count);
}

/// A trefoil: twice around the z axis, three times around the ring it winds on.
constexpr double kKnotRing = 0.575, kKnotWinding = 0.25, kKnotTube = 0.155;

DVec3 knot_point(double t) {
  const double radius = kKnotRing + kKnotWinding * std::cos(3 * t);
  return DVec3(-radius * std::sin(2 * t), radius * std::cos(2 * t), kKnotWinding * std::sin(3 * t));
}

DVec3 knot_tangent(double t) {
  const double radius = kKnotRing + kKnotWinding * std::cos(3 * t), change = -3 * kKnotWinding * std::sin(3 * t);
  const double s = std::sin(2 * t), c = std::cos(2 * t);
  return glm::normalize(
      DVec3(-change * s - 2 * radius * c, change * c - 2 * radius * s, 3 * kKnotWinding * std::cos(3 * t)));
}

/// A point of the curve with a frame that turns as little as it can: tangent, normal, tangent × normal.
struct Frame {
  double t = 0, length = 0;
  DVec3 point{0.0}, tangent{0.0}, normal{0.0};
};

DVec3 reflect(const DVec3& v, const DVec3& axis) {
  return v - axis * (2 * glm::dot(v, axis) / glm::dot(axis, axis));
}

/// The frame carried from one point of the curve to another near it: Wang, Jüttler, Zheng, Liu 2008, "Computation of
/// rotation minimizing frames", double reflection.
Frame carry(const Frame& from, double t) {
  Frame to;
  to.t = t;
  to.point = knot_point(t);
  to.tangent = knot_tangent(t);
  const DVec3 step = to.point - from.point;
  const double distance = glm::length(step);
  to.length = from.length + distance;
  if (distance == 0) {
    to.normal = from.normal;
    return to;
  }
  const DVec3 normal = reflect(from.normal, step), tangent = reflect(from.tangent, step);
  const DVec3 turn = to.tangent - tangent;
  const DVec3 carried = glm::dot(turn, turn) > 0 ? reflect(normal, turn) : normal;
  to.normal = glm::normalize(carried - to.tangent * glm::dot(carried, to.tangent));
  return to;
}

/// Frames along the whole knot, the last one back at the first point.
std::vector<Frame> knot_frames() {
  constexpr std::size_t kSteps = 6000;
  std::vector<Frame> frames(kSteps + 1);
  frames[0].point = knot_point(0);
  frames[0].tangent = knot_tangent(0);
  frames[0].normal = DVec3(0, 1, 0);  // the tangent at t = 0 has no y component
  for (std::size_t i = 1; i <= kSteps; ++i)
    frames[i] = carry(frames[i - 1], kTurn * fraction(i, kSteps));
  return frames;
}

/// The frame at a length along the knot, spread as evenly as the closing turn asks for.
Frame frame_at(const std::vector<Frame>& frames, double length, double closing_turn) {
  const auto beyond = std::upper_bound(frames.begin() + 1, frames.end() - 1, length,
                                       [](double l, const Frame& frame) { return l < frame.length; });
  const Frame& before = *(beyond - 1);
  const double share = (length - before.length) / (beyond->length - before.length);
  Frame frame = carry(before, before.t + share * (beyond->t - before.t));
  const double turn = closing_turn * length / frames.back().length;
  frame.normal = std::cos(turn) * frame.normal + std::sin(turn) * glm::cross(frame.tangent, frame.normal);
  return frame;
}

/// The angle about the tangent by which the carried frame misses the first one when it comes round.
double closing_turn_of(const std::vector<Frame>& frames) {
  const Frame& first = frames.front();
  const Frame& last = frames.back();
  const DVec3 side = glm::cross(last.tangent, last.normal);
  return std::atan2(glm::dot(first.normal, side), glm::dot(first.normal, last.normal));
}

}  // namespace

Mesh torus(std::size_t faces) {
  constexpr double kRing = 0.7, kTube = 0.3;
  const GridSize size = choose_grid(faces, kRing / kTube, {3, 3});
  return closed_grid(size, [&](std::size_t i, std::size_t j) {
    const double around = kTurn * fraction(i, size.u), across = kTurn * fraction(j, size.v);
    const DVec3 outward(std::sin(around), 0, std::cos(around));
    const DVec3 normal = std::cos(across) * outward + DVec3(0, std::sin(across), 0);
    return SurfacePoint{kRing * outward + kTube * normal, glm::normalize(normal)};
  });
}

Mesh knot(std::size_t faces) {
  const std::vector<Frame> frames = knot_frames();
  const double length = frames.back().length, closing_turn = closing_turn_of(frames);
  const GridSize size = choose_grid(faces, length / (kTurn * kKnotTube), {24, 3});
  std::vector<Frame> rings(size.u);
  for (std::size_t i = 0; i < size.u; ++i)
    rings[i] = frame_at(frames, length * fraction(i, size.u), closing_turn);
  return closed_grid(size, [&](std::size_t i, std::size_t j) {
    const Frame& ring = rings[i];
    const double across = kTurn * fraction(j, size.v);
    // Against the frame's own sense, so that rings × sections points outwards.
    const DVec3 normal =
        glm::normalize(std::cos(across) * ring.normal - std::sin(across) * glm::cross(ring.tangent, ring.normal));
    return SurfacePoint{ring.point + kKnotTube * normal, normal};
  });
}

}  // namespace limn::procedural
