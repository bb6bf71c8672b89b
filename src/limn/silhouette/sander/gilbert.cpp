#include "limn/silhouette/sander/gilbert.h"

#include <algorithm>
#include <glm/geometric.hpp>

namespace limn {
namespace {

constexpr double kInside = 1e-9;
constexpr double kConverged = 1e-15;
constexpr int kMostPasses = 64;

/// Points of the set by index; those that the closest point does not need are dropped.
struct Simplex {
  std::array<std::uint32_t, 4> index{};
  int count = 0;
};

struct Candidate {
  DVec3 point;
  Simplex simplex;
};

Candidate closest_of_vertex(std::span<const DVec3> points, std::uint32_t a) {
  return {points[a], {{a}, 1}};
}

Candidate closest_of_segment(std::span<const DVec3> points, std::uint32_t a, std::uint32_t b) {
  const DVec3 along = points[b] - points[a];
  const double length2 = glm::dot(along, along);
  const double t = -glm::dot(points[a], along);
  if (!(length2 > 0.0) || t <= 0.0) return closest_of_vertex(points, a);
  if (t >= length2) return closest_of_vertex(points, b);
  return {points[a] + (t / length2) * along, {{a, b}, 2}};
}

const Candidate& nearer(const Candidate& a, const Candidate& b) {
  return glm::dot(b.point, b.point) < glm::dot(a.point, a.point) ? b : a;
}

Candidate closest_of_triangle(std::span<const DVec3> points, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  const DVec3 ab = points[b] - points[a];
  const DVec3 ac = points[c] - points[a];
  const DVec3 normal = glm::cross(ab, ac);
  const double area2 = glm::dot(normal, normal);
  if (area2 > 0.0) {
    // The origin's projection lies inside when it is on the inner side of all three sides.
    const double wa = glm::dot(normal, glm::cross(points[b], points[c]));
    const double wb = glm::dot(normal, glm::cross(points[c], points[a]));
    const double wc = glm::dot(normal, glm::cross(points[a], points[b]));
    if (wa > 0.0 && wb > 0.0 && wc > 0.0) return {(glm::dot(points[a], normal) / area2) * normal, {{a, b, c}, 3}};
  }
  const Candidate first = nearer(closest_of_segment(points, a, b), closest_of_segment(points, b, c));
  return nearer(first, closest_of_segment(points, c, a));
}

/// Whether the origin is on the same side of the plane abc as d, or the tetrahedron is flat.
bool hides_origin(std::span<const DVec3> points, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  const DVec3 normal = glm::cross(points[b] - points[a], points[c] - points[a]);
  return glm::dot(normal, points[d] - points[a]) * glm::dot(normal, -points[a]) > 0.0;
}

Candidate closest_of_tetrahedron(std::span<const DVec3> points, const Simplex& s) {
  const auto [a, b, c, d] = s.index;
  if (hides_origin(points, a, b, c, d) && hides_origin(points, b, c, d, a) && hides_origin(points, c, d, a, b) &&
      hides_origin(points, d, a, b, c)) {
    return {DVec3(0.0), s};
  }
  const Candidate first = nearer(closest_of_triangle(points, a, b, c), closest_of_triangle(points, b, c, d));
  const Candidate second = nearer(closest_of_triangle(points, c, d, a), closest_of_triangle(points, d, a, b));
  return nearer(first, second);
}

Candidate closest_of(std::span<const DVec3> points, const Simplex& s) {
  switch (s.count) {
    case 1:
      return closest_of_vertex(points, s.index[0]);
    case 2:
      return closest_of_segment(points, s.index[0], s.index[1]);
    case 3:
      return closest_of_triangle(points, s.index[0], s.index[1], s.index[2]);
    default:
      return closest_of_tetrahedron(points, s);
  }
}

std::uint32_t lowest_along(std::span<const DVec3> points, const DVec3& direction) {
  std::size_t lowest = 0;
  double value = glm::dot(points[0], direction);
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double v = glm::dot(points[i], direction);
    if (v < value) {
      value = v;
      lowest = i;
    }
  }
  return static_cast<std::uint32_t>(lowest);
}

Simplex start_simplex(std::span<const std::uint32_t> start) {
  Simplex simplex{{0}, 0};
  for (const std::uint32_t i : start.first(std::min<std::size_t>(start.size(), 4)))
    simplex.index[static_cast<std::size_t>(simplex.count++)] = i;
  if (simplex.count == 0) simplex.count = 1;
  return simplex;
}

}  // namespace

ClosestSimplex closest_to_origin(std::span<const DVec3> points, std::span<const std::uint32_t> start) {
  if (points.empty()) return {};
  Candidate best = closest_of(points, start_simplex(start));
  for (int pass = 0; pass < kMostPasses; ++pass) {
    const double distance2 = glm::dot(best.point, best.point);
    if (distance2 <= kInside * kInside || best.simplex.count == 4) break;
    const std::uint32_t next = lowest_along(points, best.point);
    if (distance2 - glm::dot(points[next], best.point) <= kConverged) break;
    Simplex wider = best.simplex;
    wider.index[static_cast<std::size_t>(wider.count++)] = next;
    const Candidate better = closest_of(points, wider);
    // Near convergence rounding can undo a step: without progress there is nothing more to find.
    if (!(glm::dot(better.point, better.point) < distance2)) break;
    best = better;
  }
  const bool inside = glm::dot(best.point, best.point) <= kInside * kInside;
  return {inside ? DVec3(0.0) : best.point, best.simplex.index, best.simplex.count, inside};
}

}  // namespace limn
