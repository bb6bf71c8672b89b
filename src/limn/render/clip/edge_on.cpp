#include "limn/render/clip/edge_on.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "limn/base/bounds.h"

namespace limn {
namespace {

constexpr std::size_t kStride = 64;  // faces tested at a time, a bit each
constexpr float kInfinite = std::numeric_limits<float>::infinity();

double perimeter_of(const std::array<DVec3, 3>& p) {
  return glm::length(p[1] - p[0]) + glm::length(p[2] - p[1]) + glm::length(p[0] - p[2]);
}

}  // namespace

EdgeOnFaces::EdgeOnFaces(const Mesh& mesh, std::span<const Plane> planes)
    : positions_(mesh.positions), faces_(mesh.faces) {
  const std::size_t count = faces_.size();
  const std::size_t padded = (count + kStride - 1) / kStride * kStride;
  for (LineVector<float>* values : {&nx_, &ny_, &nz_, &d_, &thickness_})
    values->resize(padded);
  const Bounds bounds = face_bounds(mesh);
  center_ = bounds.empty() ? Vec3(0) : bounds.center();
  farthest_ = glm::length(center_);
  std::vector<double> perimeters(count);
  double sum = 0;
  for (std::size_t f = 0; f < count; ++f) {
    const std::array<DVec3, 3> p = {positions_[faces_[f][0]], positions_[faces_[f][1]], positions_[faces_[f][2]]};
    perimeters[f] = perimeter_of(p);
    sum += perimeters[f];
    for (const DVec3& corner : p)
      radius_ = std::max(radius_, static_cast<float>(glm::length(corner - DVec3(center_)) * 1.000001));
    const double area = glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));
    nx_[f] = planes[f].nx, ny_[f] = planes[f].ny, nz_[f] = planes[f].nz, d_[f] = planes[f].d;
    thickness_[f] = perimeters[f] > 0 ? static_cast<float>(0.999999 * area / perimeters[f]) : 0.0f;
  }
  // One bound holds for all faces but the smallest, which are looked at one by one.
  least_perimeter_ = static_cast<float>(count > 0 ? 0.1 * sum / static_cast<double>(count) : 0.0);
  for (std::size_t f = 0; f < count; ++f) {
    if (perimeters[f] < double{least_perimeter_}) thickness_[f] = 0.0f;
  }
  for (std::size_t f = count; f < padded; ++f) {
    nx_[f] = ny_[f] = nz_[f] = 0.0f;
    d_[f] = thickness_[f] = 1e30f;  // far from any eye
  }
}

/// Faces with |n·x + d| · thickness above it keep their side. Twice a face's area in the picture is
/// s² · 2A · |n·x + d| / (z0 z1 z2) with s the pixels a unit covers at distance 1; vertices that move by e change it by
/// at most e · perimeter + 3 e².
float EdgeOnFaces::bound_of(const PictureScale& scale) const {
  const double e = double{scale.vertex_error_px}, s = double{scale.pixels_per_unit};
  if (scale.eye.orthographic) return static_cast<float>(1.0001 * (e / s) * (1 + 3 * e / (s * double{least_perimeter_})));
  const double middle = glm::dot(DVec3(center_) - DVec3(scale.eye.at), DVec3(scale.forward));
  const double nearest = middle - double{radius_}, farthest = middle + double{radius_};
  if (nearest <= 1e-3 * double{radius_}) return kInfinite;
  const double lengthening = 1.0 / double{scale.widest_cosine};  // of what is seen off the axis
  const double edges = e * lengthening * farthest * farthest * farthest / (nearest * s);
  const double corners = 3 * e * e * farthest * farthest * farthest / (s * s * double{least_perimeter_});
  return static_cast<float>(1.0001 * (edges + corners));
}

bool EdgeOnFaces::may_turn(std::size_t face, const PictureScale& scale) const {
  std::array<glm::dvec2, 3> p;
  const DVec3 forward = scale.forward;
  // Any two axes across the line of sight: areas and lengths are the same about it.
  const DVec3 helper = std::abs(forward.x) < 0.7 ? DVec3(1, 0, 0) : DVec3(0, 1, 0);
  const DVec3 right = glm::normalize(glm::cross(forward, helper)), up = glm::cross(right, forward);
  for (std::size_t c = 0; c < 3; ++c) {
    const DVec3 at = DVec3(positions_[faces_[face][c]]) - (scale.eye.orthographic ? DVec3(center_) : DVec3(scale.eye.at));
    const double depth = scale.eye.orthographic ? 1.0 : glm::dot(at, forward);
    if (depth <= 1e-6 * double{radius_}) return true;  // beside or behind the eye: clipped, or not to be told from here
    p[c] = double{scale.pixels_per_unit} / depth * glm::dvec2(glm::dot(at, right), glm::dot(at, up));
  }
  const glm::dvec2 a = p[1] - p[0], b = p[2] - p[0], c = p[2] - p[1];
  const double area = std::abs(a.x * b.y - a.y * b.x), e = double{scale.vertex_error_px};
  return area <= 1.001 * e * (glm::length(a) + glm::length(b) + glm::length(c) + 3 * e);
}

void EdgeOnFaces::find(const PictureScale& scale, LineVector<Vec3>& points) const {
  const float bound = bound_of(scale);
  const bool parallel = scale.eye.orthographic;
  const Vec3 eye = parallel ? Vec3(glm::normalize(DVec3(scale.eye.at))) : scale.eye.at;
  const float offset = parallel ? 0.0f : 1.0f;
  // What rounding may add to a face's distance: of the sum's own terms, and of the plane.
  const float slack = 1e-6f * (std::abs(eye.x) + std::abs(eye.y) + std::abs(eye.z) + offset * (farthest_ + radius_));
  for (std::size_t first = 0; first < nx_.size(); first += kStride) {
    std::array<float, kStride> near;
    for (std::size_t i = 0; i < kStride; ++i) {
      const std::size_t f = first + i;
      const float side = nx_[f] * eye.x + ny_[f] * eye.y + nz_[f] * eye.z + offset * d_[f];
      near[i] = (std::abs(side) - slack) * thickness_[f];
    }
    int any = 0;
    for (const float value : near)
      any |= value <= bound ? 1 : 0;
    if (any == 0) continue;
    for (std::size_t i = 0; i < kStride && first + i < faces_.size(); ++i) {
      if (!(near[i] <= bound) || !may_turn(first + i, scale)) continue;
      for (const VertexId v : faces_[first + i])
        points.push_back(positions_[v]);
    }
  }
}

std::size_t EdgeOnFaces::memory_bytes() const {
  return positions_.size() * sizeof(Vec3) + faces_.size() * sizeof(Triangle) + 5 * nx_.size() * sizeof(float);
}

}  // namespace limn
