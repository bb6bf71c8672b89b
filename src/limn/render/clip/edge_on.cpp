#include "limn/render/clip/edge_on.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "limn/base/bounds.h"

namespace limn {
namespace {

constexpr float kInfinite = std::numeric_limits<float>::infinity();

double perimeter_of(const std::array<DVec3, 3>& p) {
  return glm::length(p[1] - p[0]) + glm::length(p[2] - p[1]) + glm::length(p[0] - p[2]);
}

/// Every face once, those together that lie together and look the same way.
std::vector<FaceId> coherent_order(const Mesh& mesh, std::span<const LeafCluster> leaves) {
  std::vector<FaceId> order;
  std::vector<bool> taken(mesh.face_count(), false);
  const auto take = [&](FaceId face) {
    if (!taken[face]) order.push_back(face);
    taken[face] = true;
  };
  for (const LeafCluster& cluster : leaves) {
    for (std::size_t i = 0; i < cluster.face_count; ++i)
      take(cluster.faces[i]);
  }
  for (std::size_t f = 0; f < mesh.face_count(); ++f)
    take(static_cast<FaceId>(f));
  return order;
}

/// Whether no pixel's centre lies within the triangle or nearer to it than twice the error. Only for triangles so thin
/// that their widening matters little: it is a box about each row of pixels that is looked at.
bool between_samples(const std::array<glm::dvec2, 3>& p, const PictureScale& scale) {
  if (scale.axis_px.x < 0.0f) return false;
  const double e = 2.0 * double{scale.vertex_error_px};
  const glm::dvec2 shift = glm::dvec2(scale.axis_px) - 0.5;  // then centres have whole coordinates
  const glm::dvec2 a = p[0] + shift, b = p[1] + shift, c = p[2] + shift;
  const glm::dvec2 low = glm::min(glm::min(a, b), c) - e, high = glm::max(glm::max(a, b), c) + e;
  const double rows = std::floor(high.y) - std::ceil(low.y);
  if (rows < 0 || std::floor(high.x) < std::ceil(low.x)) return true;
  constexpr double kMostRows = 8;
  if (rows > kMostRows) return false;
  for (double y = std::ceil(low.y); y <= high.y; y += 1.0) {
    double left = HUGE_VAL, right = -HUGE_VAL;  // where the triangle meets the strip of height 2 e about the row
    const std::array<std::array<glm::dvec2, 2>, 3> sides = {{{a, b}, {b, c}, {c, a}}};
    for (const auto& [from, to] : sides) {
      const double top = std::max(from.y, to.y), bottom = std::min(from.y, to.y);
      if (bottom > y + e || top < y - e) continue;
      for (const double height : {std::clamp(y - e, bottom, top), std::clamp(y + e, bottom, top)}) {
        const double t = top > bottom ? (height - from.y) / (to.y - from.y) : 0.0;
        const double x = from.x + t * (to.x - from.x);
        left = std::min(left, top > bottom ? x : std::min(from.x, to.x));
        right = std::max(right, top > bottom ? x : std::max(from.x, to.x));
      }
    }
    if (std::floor(right + e) >= std::ceil(left - e)) return false;
  }
  return true;
}

}  // namespace

struct EdgeOnFaces::Query {
  const PictureScale* scale;
  Vec3 eye;
  float offset;    ///< 1, or 0 for a direction
  float slack;     ///< what rounding may add to a distance
  float farthest;  ///< that anything of the mesh is from the eye; 1 for a direction
  float bound;     ///< of (|distance| - slack) times thickness, above which a face keeps its side
};

EdgeOnFaces::EdgeOnFaces(const Mesh& mesh, std::span<const LeafCluster> leaves, std::span<const Plane> planes) {
  const std::size_t count = mesh.face_count();
  const Bounds bounds = face_bounds(mesh);
  center_ = bounds.empty() ? Vec3(0) : bounds.center();
  farthest_ = glm::length(center_);
  std::vector<double> perimeters(count);
  std::vector<float> thickness(count);
  double sum = 0;
  for (std::size_t f = 0; f < count; ++f) {
    const Triangle& face = mesh.faces[f];
    const std::array<DVec3, 3> p = {mesh.positions[face[0]], mesh.positions[face[1]], mesh.positions[face[2]]};
    perimeters[f] = perimeter_of(p);
    sum += perimeters[f];
    for (const DVec3& corner : p)
      radius_ = std::max(radius_, static_cast<float>(glm::length(corner - DVec3(center_)) * 1.000001));
    const double area = glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));
    thickness[f] = perimeters[f] > 0 ? static_cast<float>(0.999999 * area / perimeters[f]) : 0.0f;
  }
  // One bound holds for all faces but the smallest, which are looked at one by one, in groups of their own.
  least_perimeter_ = static_cast<float>(count > 0 ? 0.1 * sum / static_cast<double>(count) : 0.0);
  std::vector<FaceId> regular, small;
  for (const FaceId face : coherent_order(mesh, leaves)) {
    const bool is_small = perimeters[face] < double{least_perimeter_};
    if (is_small) thickness[face] = 0.0f;
    (is_small ? small : regular).push_back(face);
  }
  regular.insert(regular.end(), small.begin(), small.end());
  for (std::size_t first = 0; first < regular.size(); first += kGroup)
    add_group(mesh, std::span(regular).subspan(first, std::min(kGroup, regular.size() - first)), planes, thickness);
  for (std::size_t first = 0; first < regular.size(); first += kGroup * kGroup)
    outer_bounds_.add(mesh, std::span(regular).subspan(first, std::min(kGroup * kGroup, regular.size() - first)),
                      planes, thickness);
  bounds_.pad();
  outer_bounds_.pad();
}

void EdgeOnFaces::Bounding::pad() {
  const std::size_t padded = (cx.size() + kGroup - 1) / kGroup * kGroup;
  for (LineVector<float>* values : {&cx, &cy, &cz, &ax, &ay, &az, &spread, &offset, &thickness})
    values->resize(padded, 0.0f);
}

void EdgeOnFaces::Bounding::add(const Mesh& mesh, std::span<const FaceId> faces, std::span<const Plane> planes,
                                std::span<const float> thicknesses) {
  DVec3 center(0), axis(0);
  for (const FaceId face : faces) {
    axis += DVec3(planes[face].nx, planes[face].ny, planes[face].nz);
    center += DVec3(mesh.positions[mesh.faces[face][0]]);
  }
  center /= static_cast<double>(faces.size());
  axis = glm::length(axis) > 0 ? glm::normalize(axis) : DVec3(0);
  double widest = 0, farthest = 0, thinnest = HUGE_VAL;
  for (const FaceId face : faces) {
    const DVec3 n(planes[face].nx, planes[face].ny, planes[face].nz);
    widest = std::max(widest, glm::length(n - axis));
    farthest = std::max(farthest, std::abs(glm::dot(n, center) + double{planes[face].d}));
    thinnest = std::min(thinnest, double{thicknesses[face]});
  }
  const auto append = [](LineVector<float>& values, double value) { values.push_back(static_cast<float>(value)); };
  append(cx, center.x), append(cy, center.y), append(cz, center.z);
  append(ax, axis.x), append(ay, axis.y), append(az, axis.z);
  append(spread, widest * 1.00001 + 1e-6);
  append(offset, farthest * 1.00001);
  append(thickness, thinnest);
}

void EdgeOnFaces::add_group(const Mesh& mesh, std::span<const FaceId> faces, std::span<const Plane> planes,
                            std::span<const float> thickness) {
  Group group{};
  Corners corners{};
  group.count = static_cast<std::uint32_t>(faces.size());
  group.thickness.fill(kInfinite);
  group.d.fill(1.0f);  // beside any eye, where there is no face
  bounds_.add(mesh, faces, planes, thickness);
  group.center = Vec3(bounds_.cx.back(), bounds_.cy.back(), bounds_.cz.back());
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const FaceId face = faces[i];
    const Plane& plane = planes[face];
    group.nx[i] = plane.nx, group.ny[i] = plane.ny, group.nz[i] = plane.nz, group.d[i] = plane.d;
    group.thickness[i] = thickness[face];
    for (std::size_t c = 0; c < 3; ++c) {
      corners[i][c] = mesh.positions[mesh.faces[face][c]];
      group.radius = std::max(group.radius, 1.00001f * glm::length(corners[i][c] - group.center));
    }
  }
  groups_.push_back(group);
  corners_.push_back(corners);
}

/// Faces within a ball keep their side where |n·x + d| times thickness is above it. Twice a face's area in the picture
/// is s² · 2A · |n·x + d| / (z0 z1 z2) with s the pixels that a unit covers at distance 1; vertices that move by e
/// change it by at most e · perimeter + 3 e².
float EdgeOnFaces::bound_of(const PictureScale& scale, const Vec3& center, float radius) const {
  const float e = scale.vertex_error_px, s = scale.pixels_per_unit;
  if (scale.eye.orthographic) return 1.0001f * (e / s) * (1.0f + 3.0f * e / (s * least_perimeter_));
  const Vec3 away = center - scale.eye.at;
  const float middle = glm::dot(away, scale.forward);
  const float nearest = middle - radius, farthest = middle + radius;
  if (nearest <= 1e-3f * radius_) return kInfinite;
  // A length in the picture, over what it would be on the axis, is at most the secant of the angle from it.
  const float secant = std::min(1.0f / scale.widest_cosine, (glm::length(away) + radius) / nearest);
  const float edges = e * secant * farthest * farthest * farthest / (nearest * s);
  const float corners = 3.0f * e * e * farthest * farthest * farthest / (s * s * least_perimeter_);
  return 1.0001f * (edges + corners);
}

bool EdgeOnFaces::may_turn(const std::array<Vec3, 3>& corners, const PictureScale& scale) const {
  std::array<glm::dvec2, 3> p;
  const bool parallel = scale.eye.orthographic;
  const DVec3 forward = scale.forward, right = scale.right, up = scale.up;
  const DVec3 from = parallel ? DVec3(scale.origin) : DVec3(scale.eye.at);
  for (std::size_t c = 0; c < 3; ++c) {
    const DVec3 at = DVec3(corners[c]) - from;
    const double depth = parallel ? 1.0 : glm::dot(at, forward);
    if (depth <= 1e-6 * double{radius_}) return true;  // beside or behind the eye: clipped, or not to be told from here
    p[c] = double{scale.pixels_per_unit} / depth * glm::dvec2(glm::dot(at, right), glm::dot(at, up));
  }
  const double e = double{scale.vertex_error_px};
  if (between_samples(p, scale)) return false;
  const glm::dvec2 a = p[1] - p[0], b = p[2] - p[0], c = p[2] - p[1];
  const double area = std::abs(a.x * b.y - a.y * b.x);
  return area <= 1.001 * e * (glm::length(a) + glm::length(b) + glm::length(c) + 3 * e);
}

void EdgeOnFaces::test_group(std::size_t g, const Query& query, LineVector<Vec3>& points) const {
  const Group& group = groups_[g];
  std::array<float, kGroup> near;
  for (std::size_t i = 0; i < kGroup; ++i) {
    const float side =
        group.nx[i] * query.eye.x + group.ny[i] * query.eye.y + group.nz[i] * query.eye.z + query.offset * group.d[i];
    near[i] = (std::abs(side) - query.slack) * group.thickness[i];
  }
  const float bound = bound_of(*query.scale, group.center, group.radius);
  int any = 0;
  for (const float value : near)
    any |= value <= bound ? 1 : 0;
  if (any == 0) return;
  for (std::size_t i = 0; i < group.count; ++i) {
    if (!(near[i] <= bound) || !may_turn(corners_[g][i], *query.scale)) continue;
    points.insert(points.end(), corners_[g][i].begin(), corners_[g][i].end());
  }
}

void EdgeOnFaces::find(const PictureScale& scale, LineVector<Vec3>& points) const {
  const bool parallel = scale.eye.orthographic;
  Query query{};
  query.scale = &scale;
  query.bound = bound_of(scale, center_, radius_);
  query.eye = parallel ? Vec3(glm::normalize(DVec3(scale.eye.at))) : scale.eye.at;
  query.offset = parallel ? 0.0f : 1.0f;
  const Vec3 size = glm::abs(query.eye);
  query.slack = 2e-6f * (size.x + size.y + size.z + query.offset * (farthest_ + radius_));
  query.farthest = parallel ? 1.00001f : 1.00001f * (glm::length(query.eye - center_) + radius_);
  std::array<bool, kGroup> outer{}, inner{};
  for (std::size_t first = 0; first < outer_bounds_.cx.size(); first += kGroup) {
    if (!outer_bounds_.test(first, query, outer)) continue;
    for (std::size_t o = 0; o < kGroup; ++o) {
      const std::size_t begin = kGroup * (first + o);
      if (!outer[o] || begin >= groups_.size() || !bounds_.test(begin, query, inner)) continue;
      for (std::size_t i = 0; i < kGroup && begin + i < groups_.size(); ++i) {
        if (inner[i]) test_group(begin + i, query, points);
      }
    }
  }
}

bool EdgeOnFaces::Bounding::test(std::size_t first, const Query& query, std::array<bool, kGroup>& may) const {
  std::array<float, kGroup> least;
  // A direction's distance from a plane has nothing of the place: the same sum without centre and offset.
  const float placed = query.offset;
  for (std::size_t i = 0; i < kGroup; ++i) {
    const std::size_t g = first + i;
    const float x = query.eye.x - placed * cx[g], y = query.eye.y - placed * cy[g], z = query.eye.z - placed * cz[g];
    const float along = std::abs(ax[g] * x + ay[g] * y + az[g] * z);
    least[i] = (along - spread[g] * query.farthest - placed * offset[g] - query.slack) * thickness[g];
  }
  int any = 0;
  for (const float value : least)
    any |= value <= query.bound ? 1 : 0;
  if (any == 0) return false;
  for (std::size_t i = 0; i < kGroup; ++i)
    may[i] = least[i] <= query.bound;
  return true;
}

std::size_t EdgeOnFaces::memory_bytes() const {
  return groups_.size() * (sizeof(Group) + sizeof(Corners) + 10 * sizeof(float));
}

}  // namespace limn
