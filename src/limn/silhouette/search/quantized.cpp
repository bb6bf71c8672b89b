#include "limn/silhouette/search/quantized.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <mutex>

#include "limn/base/parallel.h"

namespace limn {
namespace {

constexpr double kWord = kLargestWord;
constexpr double kEyeWord = 16383.0;  // half of the words: values of planes and slacks of nodes must not overflow
constexpr double kFloatUnit = 0x1.0p-24;
/// Beyond what any value can be (32767 · 16383 and roundings).
constexpr std::int32_t kAnyValue = 536'980'000;
/// Bounds from here on say nothing worth having; below, a tree's unused nodes are never entered (node_bounds.cpp).
constexpr double kUselessError = 1.0e8;

struct Extent {
  double scale = 0.0;
  double magnitude = 0.0;
};

Extent extent_of(const Mesh& mesh, std::span<const Plane> planes, const DVec3& origin, std::size_t begin,
                 std::size_t end) {
  Extent extent;
  for (std::size_t f = begin; f < end; ++f) {
    const Plane& plane = planes[f];
    const double d = plane.d;
    const double at_origin = plane.nx * origin.x + plane.ny * origin.y + plane.nz * origin.z + d;
    extent.magnitude = std::max(extent.magnitude, std::abs(d));
    extent.scale = std::max(extent.scale, std::abs(at_origin));
    for (const VertexId v : mesh.faces[f])
      extent.scale = std::max(extent.scale, glm::length(DVec3(mesh.positions[v]) - origin));
  }
  return extent;
}

std::uint32_t exact_facing(const void* context, const std::uint32_t* faces, std::uint32_t mask) {
  const ExactContext& exact = *static_cast<const ExactContext*>(context);
  std::uint32_t front = 0;
  for (std::uint32_t rest = mask; rest != 0; rest &= rest - 1) {
    const int lane = __builtin_ctz(rest);
    if (faces_eye(exact.planes[faces[lane]], exact.eye)) front |= 1u << lane;
  }
  return front;
}

std::int16_t word(double value) {
  return static_cast<std::int16_t>(std::lround(std::clamp(value, -kWord, kWord)));
}

}  // namespace

QuantizedFrame quantized_frame(const Mesh& mesh, std::span<const Plane> planes) {
  QuantizedFrame frame;
  const Bounds bounds = face_bounds(mesh);
  if (bounds.empty()) return frame;
  frame.origin = 0.5 * (DVec3(bounds.low) + DVec3(bounds.high));
  Extent all;
  std::mutex mutex;  // a maximum does not depend on the order it is taken in
  parallel_for(planes.size(), 65536, [&](std::size_t begin, std::size_t end) {
    const Extent part = extent_of(mesh, planes, frame.origin, begin, end);
    const std::scoped_lock lock(mutex);
    all.scale = std::max(all.scale, part.scale);
    all.magnitude = std::max(all.magnitude, part.magnitude);
  });
  frame.scale = std::max(all.scale * (1.0 + 0x1.0p-20), double{std::numeric_limits<float>::denorm_min()});
  frame.magnitude = all.magnitude;
  return frame;
}

QuantizedPlane quantize(const QuantizedFrame& frame, const Plane& plane) {
  if (plane.nx == 0.0f && plane.ny == 0.0f && plane.nz == 0.0f) return {0, 0, 0, -kLargestWord};
  const double at_origin =
      plane.nx * frame.origin.x + plane.ny * frame.origin.y + plane.nz * frame.origin.z + double{plane.d};
  return {word(plane.nx * kWord), word(plane.ny * kWord), word(plane.nz * kWord),
          word(at_origin / frame.scale * kWord)};
}

simd::EyeWords quantize(const QuantizedFrame& frame, const ExactContext& context) {
  return quantize_within(frame, context, 0.0);
}

simd::EyeWords quantize_within(const QuantizedFrame& frame, const ExactContext& context, double travel) {
  const Eye& eye = context.eye;
  simd::EyeWords words{};
  words.at[0] = eye.at.x;
  words.at[1] = eye.at.y;
  words.at[2] = eye.at.z;
  words.orthographic = eye.orthographic;
  words.context = &context;
  words.exact = exact_facing;
  words.error = kAnyValue;

  const DVec3 at = eye.at;
  const DVec3 v = eye.orthographic ? at : at - frame.origin;
  const double scale = eye.orthographic ? 0.0 : frame.scale;
  const double reach = glm::length(v) + scale;
  if (!std::isfinite(reach) || !(reach > 0.0)) return words;
  const double k = kEyeWord / reach;
  if (!std::isfinite(k)) return words;

  // Roundings of the plane against the eye, and of the eye against the plane, each at most half a unit a word.
  const double rounding =
      0.5 * (k * (std::abs(v.x) + std::abs(v.y) + std::abs(v.z) + scale) + 1.74 * kWord + 2.0 * kWord);
  // What faces_eye() itself may be off: five roundings in float, and the underflow of its products.
  const double terms = glm::length(at) + (eye.orthographic ? 0.0 : frame.magnitude + glm::length(frame.origin));
  const double predicate =
      kWord * k * (6.0 * kFloatUnit * (terms + travel) + 8.0 * std::numeric_limits<float>::denorm_min());
  const double moved = kWord * k * travel * (1.0 + 0x1.0p-20);
  const double error = std::ceil(rounding + predicate + moved) + 8.0;
  if (!(error < kUselessError)) return words;
  words.decisive = true;
  words.error = static_cast<std::int32_t>(error);
  words.x = word(k * v.x);
  words.y = word(k * v.y);
  words.z = word(k * v.z);
  words.h = word(k * scale);
  words.v[0] = static_cast<float>(k * v.x);
  words.v[1] = static_cast<float>(k * v.y);
  words.v[2] = static_cast<float>(k * v.z);
  words.scale = static_cast<float>(k * scale);
  words.reach = static_cast<std::int32_t>(kEyeWord) + 1;
  return words;
}

}  // namespace limn
