#include "limn/drawing/layer.h"

namespace limn {

std::string_view line_class_name(LineClass line_class) {
  switch (line_class) {
    case LineClass::kSilhouette:
      return "silhouette";
    case LineClass::kBoundary:
      return "boundary";
    case LineClass::kCrease:
      return "crease";
    case LineClass::kNonManifold:
      return "non-manifold";
  }
  return "";
}

std::string layer_name(Layer layer) {
  return std::string(line_class_name(class_of(layer))) + (is_visible(layer) ? "-visible" : "-hidden");
}

double stroke_factor(Layer layer) {
  constexpr double kOfClass[] = {1.0, 0.7, 0.5, 0.7};
  return kOfClass[static_cast<std::size_t>(class_of(layer))] * (is_visible(layer) ? 1.0 : 0.5);
}

}  // namespace limn
