#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

#include "limn/base/camera.h"
#include "limn/base/result.h"
#include "limn/drawing/layer.h"
#include "limn/silhouette/lines.h"

namespace limn {

/// What of the camera's plane lands on the page.
enum class Frame : std::uint8_t {
  kContent,  ///< all lines, as large as they fit
  kCamera,   ///< what the camera's picture shows, cut at its borders
};

struct PageOptions {
  double width_mm = 200.0;  ///< of the paper, margins included, up to 100 m; 0: as the drawing needs (mm_per_unit only)
  double height_mm = 0.0;   ///< 0: as the drawing needs, at most four times the width inside the margins; the camera's
                            ///< frame is square then
  double margin_mm = 10.0;  ///< on every side
  Frame frame = Frame::kContent;
  /// Millimetres for one unit of the mesh, for orthographic cameras; 0: as large as the page allows.
  double mm_per_unit = 0.0;
  /// How far a stroke may be from where the line was projected, and how near each other things are the same: 0.001
  /// to 1.
  double tolerance_mm = 0.002;
};

/// Where every page coordinate lies: on multiples of this many millimetres.
inline constexpr double kPageStepMm = 0.001;

/// Points drawn without lifting the pen.
struct Stroke {
  std::uint32_t begin = 0;  ///< first point in Page::points
  std::uint32_t end = 0;    ///< one past the last; at least two points, three when closed
  Layer layer = 0;
  bool closed = false;  ///< the last point is joined to the first, which is not repeated
};

/// A drawing on paper: millimetres from the lower left corner, x to the right, y upwards.
struct Page {
  double width_mm = 0;
  double height_mm = 0;
  double mm_per_unit = 0;          ///< the scale; 0 for a perspective view, which has none
  std::vector<glm::dvec2> points;  ///< multiples of kPageStepMm, rounded to double
  std::vector<Stroke> strokes;     ///< by layer
};

/// Projects lines onto a page and makes clean strokes of them.
///
/// Perspective lines are cut at the near plane and, for Frame::kContent, where they are more than 80° to the side of
/// the line of sight, up or across; the far plane cuts nothing, and orthographic lines are not cut at depth. Then, with
/// distances held against options.tolerance_mm:
/// - points that fall together become one; strokes shorter than the tolerance vanish
/// - of strokes that lie on one another over all of the stretch they share, that of the lower layer stays there (then
///   the earlier one)
/// - ends of a layer that meet where nothing else of it does are joined; through a branching point a line goes on as it
///   did in `lines`
/// - points between which a stroke is straight are left out
/// No stroke is further than four tolerances from the projection of its line; every number is finite.
///
/// Cost: sorts, O(n log n) in the number of points, but for many short strokes crowded among long ones. Same input,
/// same bits. Errors: kInvalidArgument for options out of range, a scale with a perspective camera, or a drawing larger
/// than the page at the scale asked for; kUnsuitable for coordinates beyond what can be projected.
Result<Page> lay_out(const Polylines& lines, const Camera& camera, const PageOptions& options = {});

}  // namespace limn
