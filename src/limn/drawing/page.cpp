#include "limn/drawing/page.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "limn/drawing/join.h"
#include "limn/drawing/project.h"

namespace limn {
namespace {

using drawing::Chain;
using drawing::Nodes;
using drawing::Piece;
using drawing::PlaneLimits;
using drawing::PlaneLines;
using drawing::Steps;

using DVec2 = glm::dvec2;

constexpr double kLargestPageMm = 1e5;
constexpr double kTallestPage = 4.0;          // height over width, where the drawing decides
constexpr double kWidestTangent = 5.6712818;  // of 80°

/// A box on the camera's plane.
struct PlaneBox {
  DVec2 low{std::numeric_limits<double>::max()};
  DVec2 high{std::numeric_limits<double>::lowest()};

  DVec2 size() const { return high - low; }
};

/// How the camera's plane lies on the page.
struct Placement {
  DVec2 paper_mm{};
  double mm_per_unit = 1.0;
  DVec2 middle{};  ///< of the plane, comes to the middle of the page
};

Result<void> check(const PageOptions& options, const Camera& camera) {
  const auto out_of_range = [](std::string what) {
    return fail(ErrorCode::kInvalidArgument, std::move(what), "choose it within its range");
  };
  const auto is_length = [](double mm) { return mm >= 0.0 && mm <= kLargestPageMm; };
  if (!is_length(options.width_mm) || !is_length(options.height_mm))
    return out_of_range("the page's width or height is not between 0 and 100,000 mm");
  if (!(options.margin_mm >= 0.0) || !(options.margin_mm <= kLargestPageMm))
    return out_of_range("the margin is negative or beyond 100,000 mm");
  if (!(options.tolerance_mm >= kPageStepMm) || !(options.tolerance_mm <= 1.0))
    return out_of_range("the tolerance is not between 0.001 and 1 mm");
  if (!(options.mm_per_unit >= 0.0) || !std::isfinite(options.mm_per_unit))
    return out_of_range("the scale is negative or not finite");
  if (options.mm_per_unit > 0.0 && !camera.orthographic) {
    return fail(ErrorCode::kInvalidArgument, "a perspective drawing has no scale", "project in parallel");
  }
  if (options.width_mm == 0.0 && options.mm_per_unit == 0.0)
    return out_of_range("a page without a width needs a scale");
  const double least = 2.0 * options.margin_mm + 1.0;
  const auto too_small = [least](double mm) { return mm > 0.0 && mm < least; };
  if (too_small(options.width_mm) || too_small(options.height_mm)) {
    return fail(ErrorCode::kInvalidArgument, "the margins leave less than 1 mm of the page",
                "make the page larger or the margins smaller");
  }
  return {};
}

/// Width over height of the camera's frame.
double frame_aspect(const PageOptions& options) {
  if (options.width_mm == 0.0 || options.height_mm == 0.0) return 1.0;
  return (options.width_mm - 2.0 * options.margin_mm) / (options.height_mm - 2.0 * options.margin_mm);
}

PlaneLimits limits_of(const PageOptions& options, const Camera& camera) {
  if (options.frame == Frame::kContent) {
    const double limit = camera.orthographic ? std::numeric_limits<double>::max() : kWidestTangent;
    return {limit, limit};
  }
  const double half_height = camera.orthographic ? 0.5 * camera.ortho_height : std::tan(0.5 * camera.fov_rad);
  return {half_height * frame_aspect(options), half_height};
}

PlaneBox box_of(const PlaneLines& lines, const PageOptions& options, const PlaneLimits& limits) {
  PlaneBox box;
  if (options.frame == Frame::kCamera) {
    box.high = DVec2(limits.half_width, limits.half_height);
    box.low = -box.high;
  } else if (lines.points.empty()) {
    box.low = box.high = DVec2(0.0);
  }
  if (options.frame == Frame::kContent) {
    for (const DVec2& point : lines.points) {
      box.low = glm::min(box.low, point);
      box.high = glm::max(box.high, point);
    }
  }
  return box;
}

/// Millimetres a unit, so that the box fills the room; 1 for a box without size.
double largest_scale(const DVec2& box, const DVec2& room) {
  double scale = std::numeric_limits<double>::max();
  if (box.x > 0.0) scale = std::min(scale, room.x / box.x);
  if (box.y > 0.0) scale = std::min(scale, room.y / box.y);
  return scale < std::numeric_limits<double>::max() ? scale : 1.0;
}

Result<Placement> place(const PlaneBox& box, const PageOptions& options) {
  const DVec2 margins(2.0 * options.margin_mm);
  const DVec2 asked(options.width_mm, options.height_mm);
  Placement placement;
  placement.middle = box.low + 0.5 * box.size();
  placement.mm_per_unit = options.mm_per_unit;
  if (options.mm_per_unit == 0.0) {
    DVec2 room = asked - margins;
    if (asked.y == 0.0) room.y = room.x * kTallestPage;
    placement.mm_per_unit = largest_scale(box.size(), room);
  }
  const DVec2 needed = box.size() * placement.mm_per_unit;
  if (!(needed.x <= kLargestPageMm) || !(needed.y <= kLargestPageMm)) {
    return fail(ErrorCode::kInvalidArgument, "at this scale the drawing is larger than 100 m",
                "choose a smaller scale");
  }
  for (int axis = 0; axis < 2; ++axis) {
    // Room for the last bit of a scale that was made to fit.
    if (asked[axis] > 0.0 && needed[axis] > (asked[axis] - margins[axis]) * (1.0 + 1e-12)) {
      return fail(ErrorCode::kInvalidArgument,
                  fmt::format("at this scale the drawing is {:.1f} x {:.1f} mm, more than the page inside its margins",
                              needed.x, needed.y),
                  "choose a larger page or a smaller scale");
    }
    const double length = asked[axis] > 0.0 ? asked[axis] : needed[axis] + margins[axis];
    placement.paper_mm[axis] = std::round(length / kPageStepMm) * kPageStepMm;
  }
  return placement;
}

std::vector<Piece> pieces_of(const PlaneLines& lines, const Placement& placement, Nodes& nodes) {
  const auto node = [&](std::uint32_t i) {
    const DVec2 mm = (lines.points[i] - placement.middle) * placement.mm_per_unit + 0.5 * placement.paper_mm;
    return nodes.at(Steps(std::lround(mm.x / kPageStepMm), std::lround(mm.y / kPageStepMm)));
  };
  std::vector<Piece> pieces;
  pieces.reserve(lines.points.size());
  for (std::uint32_t number = 0; number < lines.runs.size(); ++number) {
    const drawing::Run& run = lines.runs[number];
    const drawing::NodeId first = node(run.begin);
    drawing::NodeId before = first;
    for (std::uint32_t i = run.begin + 1; i <= run.end; ++i) {
      if (i == run.end && !run.closed) break;
      const drawing::NodeId next = i == run.end ? first : node(i);
      if (next != before) pieces.push_back({before, next, number, run.layer});
      before = next;
    }
  }
  return pieces;
}

void append(const Chain& chain, const Nodes& nodes, Page& page) {
  const auto begin = static_cast<std::uint32_t>(page.points.size());
  for (const drawing::NodeId node : chain.nodes)
    page.points.push_back(DVec2(nodes[node]) * kPageStepMm);
  page.strokes.push_back({begin, static_cast<std::uint32_t>(page.points.size()), chain.layer, chain.closed});
}

bool all_finite(const PlaneLines& lines) {
  return std::all_of(lines.points.begin(), lines.points.end(),
                     [](const DVec2& point) { return std::isfinite(point.x) && std::isfinite(point.y); });
}

}  // namespace

Result<Page> lay_out(const Polylines& lines, const Camera& camera, const PageOptions& options) {
  if (Result<void> good = check(options, camera); !good) return tl::unexpected(good.error());
  const PlaneLimits limits = limits_of(options, camera);
  const PlaneLines projected = drawing::project(lines, camera, limits);
  if (!all_finite(projected)) {
    return fail(ErrorCode::kUnsuitable, "its coordinates are too large to be projected", "scale the mesh");
  }
  const Result<Placement> placement = place(box_of(projected, options, limits), options);
  if (!placement) return tl::unexpected(placement.error());
  const double tolerance_steps = options.tolerance_mm / kPageStepMm;
  Nodes nodes(tolerance_steps, projected.points.size());
  const std::vector<Piece> pieces =
      drawing::without_overlaps(pieces_of(projected, *placement, nodes), nodes, tolerance_steps);
  Page page;
  page.width_mm = placement->paper_mm.x;
  page.height_mm = placement->paper_mm.y;
  page.mm_per_unit = camera.orthographic ? placement->mm_per_unit : 0.0;
  for (Chain& chain : drawing::join(pieces)) {
    drawing::straighten(chain, nodes, tolerance_steps);
    append(chain, nodes, page);
  }
  return page;
}

}  // namespace limn
