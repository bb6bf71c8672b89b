#include "limn/drawing/project.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <optional>

namespace limn::drawing {
namespace {

/// What of a segment from 0 to 1 is left after cuts.
struct Span1 {
  double from = 0.0;
  double to = 1.0;
};

/// Keeps where a function that is `a` at 0, `b` at 1 and linear between is not negative; false when nothing is left.
bool keep(Span1& span, double a, double b) {
  if (a >= 0.0 && b >= 0.0) return true;
  if (a < 0.0 && b < 0.0) return false;
  const double crossing = a / (a - b);
  if (a < 0.0) {
    span.from = std::max(span.from, crossing);
  } else {
    span.to = std::min(span.to, crossing);
  }
  return span.from < span.to;
}

class Projector {
 public:
  Projector(const Camera& camera, const PlaneLimits& limits)
      : eye_(camera.eye),
        to_eye_space_(glm::dmat3(view_matrix(camera))),
        near_(camera.near_distance),
        perspective_(!camera.orthographic),
        limits_(limits) {}

  /// x to the right, y upwards, z the distance before the eye.
  DVec3 eye_space(const Vec3& point) const {
    const DVec3 p = to_eye_space_ * (DVec3(point) - eye_);
    return {p.x, p.y, -p.z};
  }

  std::optional<Span1> visible_span(const DVec3& a, const DVec3& b) const {
    Span1 span;
    if (perspective_ && !keep(span, a.z - near_, b.z - near_)) return std::nullopt;
    const double depth_a = perspective_ ? a.z : 1.0;
    const double depth_b = perspective_ ? b.z : 1.0;
    const double x_a = limits_.half_width * depth_a;
    const double x_b = limits_.half_width * depth_b;
    const double y_a = limits_.half_height * depth_a;
    const double y_b = limits_.half_height * depth_b;
    const bool left = keep(span, x_a + a.x, x_b + b.x) && keep(span, x_a - a.x, x_b - b.x) &&
                      keep(span, y_a + a.y, y_b + b.y) && keep(span, y_a - a.y, y_b - b.y);
    return left ? std::optional(span) : std::nullopt;
  }

  glm::dvec2 on_plane(const DVec3& p) const {
    return perspective_ ? glm::dvec2(p.x / p.z, p.y / p.z) : glm::dvec2(p.x, p.y);
  }

 private:
  DVec3 eye_;
  glm::dmat3 to_eye_space_;
  double near_;
  bool perspective_;
  PlaneLimits limits_;
};

/// Adds what is left of one polyline, as one run or several.
void append(const Projector& projector, const Polylines& lines, const Polyline& line, PlaneLines& out) {
  const std::uint32_t count = line.end - line.begin;
  const std::uint32_t segments = line.closed ? count : count - 1;
  const Layer layer = layer_of(line.line_class, line.visible);
  const auto point = [&](std::uint32_t i) { return projector.eye_space(lines.points[line.begin + i % count]); };
  const auto size = [&out] { return static_cast<std::uint32_t>(out.points.size()); };
  std::uint32_t begin = size();
  const auto finish = [&](bool closed) {
    if (size() > begin + 1) out.runs.push_back({begin, size(), layer, closed});
    begin = size();
  };
  bool whole = true;
  DVec3 a = point(0);
  for (std::uint32_t i = 0; i < segments; ++i) {
    const DVec3 b = point(i + 1);
    const std::optional<Span1> span = projector.visible_span(a, b);
    const bool cut_before = !span || span->from > 0.0;
    whole = whole && span && span->from == 0.0 && span->to == 1.0;
    if (cut_before) finish(false);
    if (span) {
      if (size() == begin) out.points.push_back(projector.on_plane(cut_before ? a + (b - a) * span->from : a));
      const bool last_of_loop = whole && line.closed && i + 1 == segments;
      if (!last_of_loop) out.points.push_back(projector.on_plane(span->to < 1.0 ? a + (b - a) * span->to : b));
      if (span->to < 1.0) finish(false);
    }
    a = b;
  }
  finish(whole && line.closed);
}

}  // namespace

PlaneLines project(const Polylines& lines, const Camera& camera, const PlaneLimits& limits) {
  const Projector projector(camera, limits);
  PlaneLines out;
  out.points.reserve(lines.points.size());
  out.runs.reserve(lines.lines.size());
  for (const Polyline& line : lines.lines) {
    if (line.end - line.begin >= 2) append(projector, lines, line, out);
  }
  return out;
}

}  // namespace limn::drawing
