#pragma once

#include <string>

#include "limn/drawing/page.h"

namespace limn {

struct SvgOptions {
  double stroke_mm = 0.5;   ///< width of the visible silhouette; the others in proportion (stroke_factor)
  std::string title;        ///< what the drawing shows; may be any bytes, those that XML forbids are replaced
  std::string description;  ///< a line about how it was made
};

/// The page as an SVG 1.1 document: units are millimetres, y downwards, one group a layer, which Inkscape shows as a
/// layer ("silhouette hidden"); hidden ones come first, beneath the visible, and are dashed. One path element a stroke.
///
/// Same page, same bytes; well-formed whatever the texts hold. Cost: one pass.
std::string svg_text(const Page& page, const SvgOptions& options = {});

}  // namespace limn
