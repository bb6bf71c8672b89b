#include "limn/silhouette/eye.h"

#include <cmath>

namespace limn {

Eye eye_of(const Camera& camera) {
  if (camera.orthographic) return {camera.eye - camera.target, true};
  return {camera.eye, false};
}

View view_of(const Camera& camera, int height_px) {
  const float height = static_cast<float>(height_px);
  const float visible = camera.orthographic ? camera.ortho_height : 2.0f * std::tan(0.5f * camera.fov_rad);
  return {eye_of(camera), height / visible};
}

}  // namespace limn
