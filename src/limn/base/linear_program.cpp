#include "limn/base/linear_program.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>
#include <vector>

#include "limn/base/random.h"

namespace limn {
namespace {

constexpr double kParallel = 1e-12;  // sine of an angle between planes
constexpr double kRounding = 1e-15;
constexpr double kLevel = 1e-13;     // slope of a line against a plane
constexpr double kTie = 1e-9;        // slope of the cost
constexpr double kDistance = 1e-11;  // in units of the frame: what may be missing of a line
constexpr double kOnPlane = 1e-12;   // the same: how far outside a point may be
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kSmall = 64;

/// The plane of a half-space in the solver's frame, its normal of unit length.
struct FramePlane {
  DVec3 n;
  double d;
  std::uint32_t index;
};

/// An optimum of some of the half-spaces: `point`, or when `escape` is not 0, infinitely far along `escape` from it.
/// This is where the optimum of cost·x + ε|x|²/2 tends to as ε → 0: its terms of order 1/ε and 1.
struct Optimum {
  DVec3 escape{0.0};
  DVec3 point{0.0};
  Support support{};
};

DVec3 without_noise(const DVec3& escape) {
  return glm::dot(escape, escape) > kTie * kTie ? escape : DVec3(0.0);
}

bool violates(const Optimum& optimum, const FramePlane& plane) {
  // Relative to the escape's length: nearly parallel planes make short escapes of small slope.
  const double rise = glm::dot(plane.n, optimum.escape);
  if (rise * rise > kRounding * kRounding * glm::dot(optimum.escape, optimum.escape)) return rise < 0.0;
  const double reach = std::max(1.0, glm::dot(optimum.point, optimum.point));
  return glm::dot(plane.n, optimum.point) + plane.d < -kOnPlane * std::sqrt(reach);
}

class Solver {
 public:
  Solver(std::span<const FramePlane> planes, const DVec3& cost) : planes_(planes), cost_(cost) {}

  /// \returns whether there is a feasible point
  bool solve(Optimum& optimum) const {
    optimum = {without_noise(-cost_), DVec3(0.0), {}};
    for (std::size_t i = 0; i < planes_.size(); ++i) {
      if (violates(optimum, planes_[i]) && !solve_in_plane(i, optimum)) return false;
    }
    return true;
  }

 private:
  /// The optimum of the planes before i, within the plane i.
  bool solve_in_plane(std::size_t i, Optimum& optimum) const {
    const FramePlane& plane = planes_[i];
    const DVec3 down = glm::dot(cost_, plane.n) * plane.n - cost_;
    optimum.escape = without_noise(down - glm::dot(down, plane.n) * plane.n);
    optimum.point = -plane.d * plane.n;
    optimum.support = {{plane.index}, 1};
    for (std::size_t j = 0; j < i; ++j) {
      if (violates(optimum, planes_[j]) && !solve_on_line(i, j, optimum)) return false;
    }
    return true;
  }

  /// The part of a line that lies in the half-spaces.
  struct Interval {
    DVec3 direction, nearest;
    double low, high;
    std::size_t low_plane, high_plane;
  };

  /// The optimum of the planes before j, on the line that the planes i and j share.
  bool solve_on_line(std::size_t i, std::size_t j, Optimum& optimum) const {
    const FramePlane& a = planes_[i];
    const FramePlane& b = planes_[j];
    // Across the line within plane a; made orthogonal twice, so that both planes hold the line to within rounding even
    // where they are nearly parallel.
    DVec3 across = b.n - glm::dot(b.n, a.n) * a.n;
    across -= glm::dot(across, a.n) * a.n;
    const double sine = glm::length(across);
    // Of parallel planes that face the same way one implies the other, and rounding alone can say otherwise.
    if (sine < kParallel) return glm::dot(a.n, b.n) > 0.0;
    across /= sine;
    const double step = (a.d * glm::dot(a.n, b.n) - b.d) / glm::dot(b.n, across);
    return finish_on_line(i, j, glm::cross(a.n, across), step * across - a.d * a.n, optimum);
  }

  bool finish_on_line(std::size_t i, std::size_t j, const DVec3& direction, const DVec3& nearest,
                      Optimum& optimum) const {
    Interval line{direction, nearest, -kInfinity, kInfinity, i, i};
    double lowest = -kInfinity;  // as line.low and line.high, with all half-spaces moved outwards by the tolerance
    double highest = kInfinity;
    const double reach = std::max(1.0, glm::length(nearest));
    for (std::size_t k = 0; k < j; ++k) {
      const double slope = glm::dot(planes_[k].n, direction);
      const double side = glm::dot(planes_[k].n, nearest) + planes_[k].d;
      if (std::abs(slope) < kLevel) {
        if (side < -kDistance * reach) return false;
        continue;
      }
      const double t = -side / slope;
      const double slack = kDistance * std::max(reach, std::abs(t)) / std::abs(slope);
      if (slope > 0.0) {
        lowest = std::max(lowest, t - slack);
        if (t > line.low) {
          line.low = t;
          line.low_plane = k;
        }
      } else {
        highest = std::min(highest, t + slack);
        if (t < line.high) {
          line.high = t;
          line.high_plane = k;
        }
      }
    }
    if (lowest > highest) return false;
    place_on_line(i, j, line, optimum);
    return true;
  }

  void place_on_line(std::size_t i, std::size_t j, const Interval& line, Optimum& optimum) const {
    const double slope = glm::dot(cost_, line.direction);
    double t = 0.0;
    if (slope > kTie) t = -kInfinity;
    if (slope < -kTie) t = kInfinity;
    std::size_t third = i;
    if (t <= line.low && line.low > -kInfinity) {
      t = line.low;
      third = line.low_plane;
    } else if (t >= line.high && line.high < kInfinity) {
      t = line.high;
      third = line.high_plane;
    }
    const bool bounded = std::isfinite(t);
    optimum.escape = bounded ? DVec3(0.0) : -slope * line.direction;
    optimum.point = bounded ? line.nearest + t * line.direction : line.nearest;
    optimum.support = {{planes_[i].index, planes_[j].index, planes_[third].index}, third == i ? 2 : 3};
  }

  std::span<const FramePlane> planes_;
  DVec3 cost_;
};

/// Into the frame of the options.
void to_frame(std::span<const HalfSpace> half_spaces, const LinearProgramOptions& options,
              std::span<FramePlane> planes) {
  for (std::size_t i = 0; i < half_spaces.size(); ++i) {
    const HalfSpace& half_space = half_spaces[i];
    const double length = glm::length(half_space.normal);
    planes[i] = {half_space.normal / length,
                 (half_space.offset + glm::dot(half_space.normal, options.near)) / (length * options.scale),
                 static_cast<std::uint32_t>(i)};
  }
}

void shuffle(Random& random, std::span<FramePlane> planes) {
  for (std::size_t i = 1; i < planes.size(); ++i)
    std::swap(planes[i], planes[random.below(i + 1)]);
}

LinearProgramResult solve_in_frame(std::span<FramePlane> planes, const DVec3& cost,
                                   const LinearProgramOptions& options) {
  const double length = glm::length(cost);
  const DVec3 unit_cost = length > 0.0 ? cost / length : DVec3(0.0);
  Random random(options.seed);
  Optimum optimum;
  // Infeasible must be so in two orders: nearly parallel planes can mislead one.
  bool feasible = false;
  for (int attempt = 0; attempt < 2 && !feasible; ++attempt) {
    shuffle(random, planes);
    feasible = Solver(planes, unit_cost).solve(optimum);
  }
  if (!feasible) return {};
  const bool bounded = optimum.escape == DVec3(0.0);
  const auto begin = optimum.support.index.begin();
  std::sort(begin, begin + optimum.support.count);
  return {bounded ? LinearProgramOutcome::kOptimal : LinearProgramOutcome::kUnbounded,
          options.near + options.scale * optimum.point, optimum.support};
}

}  // namespace

LinearProgramResult solve_linear_program(std::span<const HalfSpace> half_spaces, const DVec3& cost,
                                         const LinearProgramOptions& options) {
  assert(options.scale > 0.0);
  if (half_spaces.size() <= kSmall) {
    std::array<FramePlane, kSmall> small;
    const std::span<FramePlane> planes = std::span(small).first(half_spaces.size());
    to_frame(half_spaces, options, planes);
    return solve_in_frame(planes, cost, options);
  }
  std::vector<FramePlane> planes(half_spaces.size());
  to_frame(half_spaces, options, planes);
  return solve_in_frame(planes, cost, options);
}

}  // namespace limn
