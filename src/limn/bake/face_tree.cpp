#include "limn/bake/face_tree.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "limn/bake/float4.h"

namespace limn::bake_detail {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
/// What triangles reach beyond their sides, as a share of their heights, so that no ray slips between two of them.
constexpr float kEdge = 2e-6f;
/// Four children a node, so a path leaves at most three behind at each of its nodes; trees are about 20 deep, and 300
/// only where faces lie on each other.
constexpr std::size_t kStackRoom = 512;

/// A child still to be looked at, and how near it may be.
struct Waiting {
  std::uint32_t child;
  float distance;
};

/// Children in order of distance, the nearest on top. Room for any tree: what does not fit the array goes to a vector.
class Stack {
 public:
  void push(Waiting waiting) {
    if (size_ < kStackRoom) {
      room_[size_++] = waiting;
    } else {
      more_.push_back(waiting);
    }
  }
  bool pop(Waiting& waiting) {
    if (!more_.empty()) {
      waiting = more_.back();
      more_.pop_back();
      return true;
    }
    if (size_ == 0) return false;
    waiting = room_[--size_];
    return true;
  }

 private:
  std::array<Waiting, kStackRoom> room_;
  std::size_t size_ = 0;
  std::vector<Waiting> more_;
};

Point4 load_point(const float (&from)[3][4]) {
  return {load4(from[0]), load4(from[1]), load4(from[2])};
}

/// Pushes the children nearer than `limit`, the farthest first.
void push_children(const std::uint32_t (&child)[4], Float4 distance, float limit, Stack& stack) {
  std::array<Waiting, 4> near;
  std::size_t count = 0;
  for (std::size_t c = 0; c < 4; ++c) {
    const float d = distance[c];
    if (!(d < limit)) continue;
    std::size_t at = count++;
    for (; at > 0 && near[at - 1].distance < d; --at)
      near[at] = near[at - 1];
    near[at] = {child[c], d};
  }
  for (std::size_t i = 0; i < count; ++i)
    stack.push(near[i]);
}

/// Squares of the distances from a point to four segments that begin `from` the point and run along `edge`.
Float4 segment_distances(const Point4& from, const Point4& edge) {
  const Float4 t = clamp4(dot4(from, edge) / dot4(edge, edge), all4(0.0f), all4(1.0f));
  const Point4 rest = from - edge * t;
  return dot4(rest, rest);
}

/// Squares of the distances from a point to four triangles; `from` leads from their first corner to the point.
/// Divisions by zero give NaN or infinity, which the comparisons turn away.
Float4 triangle_distances(const Point4& from, const Point4& edge_1, const Point4& edge_2) {
  const Float4 d11 = dot4(edge_1, edge_1), d12 = dot4(edge_1, edge_2), d22 = dot4(edge_2, edge_2);
  const Float4 p1 = dot4(from, edge_1), p2 = dot4(from, edge_2);
  const Float4 area = d11 * d22 - d12 * d12;
  const Float4 u = (d22 * p1 - d12 * p2) / area;
  const Float4 v = (d11 * p2 - d12 * p1) / area;
  const Point4 rest = from - edge_1 * u - edge_2 * v;
  const Float4 zero = all4(0.0f);
  const Int4 inside = (u >= zero) & (v >= zero) & (u + v <= all4(1.0f));
  const Float4 borders = min4(min4(segment_distances(from, edge_1), segment_distances(from, edge_2)),
                              segment_distances(from - edge_1, edge_2 - edge_1));
  const Float4 within = inside ? dot4(rest, rest) : all4(kInfinity);
  return min4(within, borders);
}

/// The share of the segment a + t·d that is nearest to p.
double nearest_on_segment(const DVec3& p, const DVec3& a, const DVec3& d) {
  const double length = glm::dot(d, d);
  return length > 0.0 ? std::clamp(glm::dot(p - a, d) / length, 0.0, 1.0) : 0.0;
}

/// Finite, so that a ray within a box's side is not lost to 0 · ∞.
float inverse_of(float component) {
  constexpr float kSmallest = 1e-20f;
  return 1.0f / (std::abs(component) < kSmallest ? std::copysign(kSmallest, component) : component);
}

}  // namespace

Vec3 FaceTree::area_vector(FaceId face) const {
  const Triangle& t = faces_[face];
  const Vec3 a = positions_[t[0]];
  return glm::cross(positions_[t[1]] - a, positions_[t[2]] - a);
}

/// In double: the inside of the face where the foot lies there, else the nearest of its three sides.
FacePoint FaceTree::place_on(FaceId face, const Vec3& point) const {
  const Triangle& t = faces_[face];
  const DVec3 p(point), a(positions_[t[0]]), b(positions_[t[1]]), c(positions_[t[2]]);
  const DVec3 e1 = b - a, e2 = c - a;
  const DVec3 normal = glm::cross(e1, e2);
  const double area = glm::dot(normal, normal);
  if (area > 0.0) {
    const double u = glm::dot(glm::cross(p - a, e2), normal) / area;
    const double v = glm::dot(glm::cross(e1, p - a), normal) / area;
    if (u >= 0.0 && v >= 0.0 && u + v <= 1.0) {
      return {face, static_cast<float>(u), static_cast<float>(v),
              static_cast<float>(glm::length(p - (a + u * e1 + v * e2)))};
    }
  }
  const double t1 = nearest_on_segment(p, a, e1), t2 = nearest_on_segment(p, a, e2);
  const double t3 = nearest_on_segment(p, b, c - b);
  const double d1 = glm::length(p - (a + t1 * e1)), d2 = glm::length(p - (a + t2 * e2));
  const double d3 = glm::length(p - (b + t3 * (c - b)));
  if (d1 <= d2 && d1 <= d3) return {face, static_cast<float>(t1), 0.0f, static_cast<float>(d1)};
  if (d2 <= d3) return {face, 0.0f, static_cast<float>(t2), static_cast<float>(d2)};
  return {face, static_cast<float>(1.0 - t3), static_cast<float>(t3), static_cast<float>(d3)};
}

FacePoint FaceTree::closest(const Vec3& p, const FacePoint& hint) const {
  FaceId best = kInvalidId;
  float nearest = kInfinity;
  if (hint.face < faces_.size()) {
    best = hint.face;
    const float distance = place_on(best, p).distance;
    nearest = distance * distance;
  }
  best = nearest_face(p, best, nearest);
  return place_on(best == kInvalidId ? 0 : best, p);
}

FacePoint FaceTree::closest_within(const Vec3& p, float radius) const {
  const FaceId best = nearest_face(p, kInvalidId, radius * radius);
  return best == kInvalidId ? FacePoint{} : place_on(best, p);
}

/// The face nearest to p and nearer than the distance; `best` where there is none.
FaceId FaceTree::nearest_face(const Vec3& p, FaceId best, float squared_distance) const {
  float nearest = squared_distance;
  const Point4 point{all4(p.x), all4(p.y), all4(p.z)};
  Stack stack;
  stack.push({0, -1.0f});
  for (Waiting next{}; stack.pop(next);) {
    if (next.distance >= nearest) continue;
    if ((next.child & kLeafBit) != 0) {
      const Leaf& leaf = leaves_[next.child & ~kLeafBit];
      const Float4 distances =
          triangle_distances(point - load_point(leaf.corner), load_point(leaf.edge_1), load_point(leaf.edge_2));
      for (std::size_t i = 0; i < 4; ++i) {
        if (!(distances[i] < nearest)) continue;
        nearest = distances[i];
        best = leaf.face[i];
      }
      continue;
    }
    const Node& node = nodes_[next.child];
    const Point4 low = load_point(node.low), high = load_point(node.high);
    const Float4 zero = all4(0.0f);
    const Point4 away{max4(max4(low.x - point.x, point.x - high.x), zero),
                      max4(max4(low.y - point.y, point.y - high.y), zero),
                      max4(max4(low.z - point.z, point.z - high.z), zero)};
    push_children(node.child, dot4(away, away), nearest, stack);
  }
  return best;
}

/// Slabs for the boxes; triangles after Möller and Trumbore.
template <bool kAny>
FacePoint FaceTree::trace(const TreeRay& ray) const {
  FacePoint hit;
  hit.distance = ray.far;
  const Point4 origin{all4(ray.origin.x), all4(ray.origin.y), all4(ray.origin.z)};
  const Point4 direction{all4(ray.direction.x), all4(ray.direction.y), all4(ray.direction.z)};
  const Point4 inverse{all4(inverse_of(ray.direction.x)), all4(inverse_of(ray.direction.y)),
                       all4(inverse_of(ray.direction.z))};
  const Float4 zero = all4(0.0f);
  Stack stack;
  stack.push({0, 0.0f});
  for (Waiting next{}; stack.pop(next);) {
    if (next.distance > hit.distance) continue;
    if ((next.child & kLeafBit) != 0) {
      const Leaf& leaf = leaves_[next.child & ~kLeafBit];
      const Point4 edge_1 = load_point(leaf.edge_1), edge_2 = load_point(leaf.edge_2);
      const Point4 from = origin - load_point(leaf.corner);
      const Point4 across = cross4(direction, edge_2), turned = cross4(from, edge_1);
      const Float4 determinant = dot4(edge_1, across);
      const Float4 u = dot4(from, across) / determinant, v = dot4(direction, turned) / determinant;
      const Float4 t = dot4(edge_2, turned) / determinant;
      const Int4 met = (u >= all4(-kEdge)) & (v >= all4(-kEdge)) & (u + v <= all4(1.0f + kEdge)) & (t >= zero) &
                       (t <= all4(hit.distance));
      for (std::size_t i = 0; i < 4; ++i) {
        if (met[i] == 0 || t[i] > hit.distance || (hit.face != kInvalidId && t[i] == hit.distance)) continue;
        hit = {leaf.face[i], std::clamp(u[i], 0.0f, 1.0f), std::clamp(v[i], 0.0f, 1.0f), t[i]};
        if (kAny) return hit;
      }
      continue;
    }
    const Node& node = nodes_[next.child];
    const Point4 low = load_point(node.low) - origin, high = load_point(node.high) - origin;
    const Float4 x0 = low.x * inverse.x, x1 = high.x * inverse.x;
    const Float4 y0 = low.y * inverse.y, y1 = high.y * inverse.y;
    const Float4 z0 = low.z * inverse.z, z1 = high.z * inverse.z;
    Float4 enter = max4(min4(z0, z1), max4(min4(y0, y1), max4(min4(x0, x1), zero)));
    const Float4 leave = min4(max4(z0, z1), min4(max4(y0, y1), min4(max4(x0, x1), all4(hit.distance))));
    // A little wider than computed, so that rounding loses no face on a box's side.
    enter = enter <= leave * all4(1.0000008f) ? enter : all4(kInfinity);
    for (std::size_t c = 0; c < 4; ++c) {
      if (!(node.low[0][c] <= node.high[0][c])) enter[c] = kInfinity;
    }
    push_children(node.child, enter, kInfinity, stack);
  }
  return hit;
}

FacePoint FaceTree::first_hit(const TreeRay& ray) const {
  return trace<false>(ray);
}

bool FaceTree::meets_any(const TreeRay& ray) const {
  return trace<true>(ray).face != kInvalidId;
}

}  // namespace limn::bake_detail
