#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "limn/silhouette/lines.h"

namespace limn {

/// Every class, in the order in which drawings hold them.
inline constexpr std::array kLineClasses{LineClass::kSilhouette, LineClass::kBoundary, LineClass::kCrease,
                                         LineClass::kNonManifold};

/// "silhouette", "boundary", "crease", "non-manifold": the names in every file format and on the command line.
std::string_view line_class_name(LineClass line_class);

/// One layer of a drawing: the strokes of one class that are all visible or all hidden.
///
/// Numbered by precedence, from 0: where two strokes lie on one another, that of the lower layer is drawn. Visible
/// lines take precedence over hidden ones, as in technical drawings (ISO 128).
using Layer = std::uint8_t;
inline constexpr std::size_t kLayerCount = 2 * kLineClasses.size();

constexpr Layer layer_of(LineClass line_class, bool visible) {
  return static_cast<Layer>(static_cast<std::size_t>(line_class) + (visible ? 0 : kLineClasses.size()));
}
constexpr bool is_visible(Layer layer) {
  return layer < kLineClasses.size();
}
constexpr LineClass class_of(Layer layer) {
  return static_cast<LineClass>(layer % kLineClasses.size());
}

/// "silhouette-visible", "crease-hidden".
std::string layer_name(Layer layer);

/// How wide a layer is drawn, as a multiple of the visible silhouette: boundaries 0.7, non-manifold edges 0.7, creases
/// 0.5, hidden lines half of that.
double stroke_factor(Layer layer);

}  // namespace limn
