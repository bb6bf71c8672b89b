#include <algorithm>

#include "limn/render/render.h"

namespace limn {

Vec3 level_color(float level, float max_level) {
  const float x = max_level > 0.0f ? std::clamp(level / max_level, 0.0f, 1.0f) : 0.0f;
  // Three stops, evenly lit against a light face: dark blue, green, yellow.
  const Vec3 stops[3] = {Vec3(0.13f, 0.20f, 0.47f), Vec3(0.10f, 0.60f, 0.45f), Vec3(0.98f, 0.80f, 0.10f)};
  const float scaled = x * 2.0f;
  const int i = scaled >= 1.0f ? 1 : 0;
  const float t = scaled - static_cast<float>(i);
  return stops[i] * (1.0f - t) + stops[i + 1] * t;
}

}  // namespace limn
