#include "limn/hull/triangle_intersection.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "limn/base/orient3d.h"

namespace limn {
namespace {

/// A point as seen along an axis, in a plane.
struct Flat {
  float u, v;
};

Flat flatten(const Vec3& p, int axis) {
  return {p[(axis + 1) % 3], p[(axis + 2) % 3]};
}

/// 1 where a, b, c turn left, -1 where right, 0 on a line: seen from above, the orientation of a point over the plane.
int turn(const Flat& a, const Flat& b, const Flat& c) {
  return orient3d(Vec3(a.u, a.v, 0), Vec3(b.u, b.v, 0), Vec3(c.u, c.v, 0), Vec3(c.u, c.v, 1));
}

bool between(float a, float b, float x) {
  return std::min(a, b) <= x && x <= std::max(a, b);
}

bool in_box(const Flat& p, const Flat& q, const Flat& x) {
  return between(p.u, q.u, x.u) && between(p.v, q.v, x.v);
}

/// Two segments in a plane, ends included.
bool segments_meet(const Flat& p, const Flat& q, const Flat& r, const Flat& s) {
  const int a = turn(p, q, r), b = turn(p, q, s), c = turn(r, s, p), d = turn(r, s, q);
  if (a * b < 0 && c * d < 0) return true;
  return (a == 0 && in_box(p, q, r)) || (b == 0 && in_box(p, q, s)) || (c == 0 && in_box(r, s, p)) ||
         (d == 0 && in_box(r, s, q));
}

/// An axis along which the triangle does not look like a line; -1 where it is one.
int clear_axis(const Corners& t) {
  for (int axis = 0; axis < 3; ++axis) {
    if (turn(flatten(t[0], axis), flatten(t[1], axis), flatten(t[2], axis)) != 0) return axis;
  }
  return -1;
}

bool boxes_meet(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
  for (int axis = 0; axis < 3; ++axis) {
    if (std::max(p[axis], q[axis]) < std::min(r[axis], s[axis])) return false;
    if (std::max(r[axis], s[axis]) < std::min(p[axis], q[axis])) return false;
  }
  return true;
}

/// Two segments in space, ends included.
bool segments_meet(const Vec3& p, const Vec3& q, const Vec3& r, const Vec3& s) {
  if (!boxes_meet(p, q, r, s) || orient3d(p, q, r, s) != 0) return false;
  // All four in one plane. Seen along an axis that keeps it a plane, nothing else falls together.
  for (const Corners& t : {Corners{p, q, r}, Corners{p, q, s}, Corners{r, s, p}, Corners{r, s, q}}) {
    const int axis = clear_axis(t);
    if (axis >= 0) return segments_meet(flatten(p, axis), flatten(q, axis), flatten(r, axis), flatten(s, axis));
  }
  return true;  // all four on one line, where boxes that meet do so on it
}

bool in_triangle(const Flat& x, const Flat& a, const Flat& b, const Flat& c) {
  const int i = turn(a, b, x), j = turn(b, c, x), k = turn(c, a, x);
  return (i >= 0 && j >= 0 && k >= 0) || (i <= 0 && j <= 0 && k <= 0);
}

bool meets_in_plane(const Vec3& p, const Vec3& q, const Corners& t, int axis) {
  const Flat a = flatten(t[0], axis), b = flatten(t[1], axis), c = flatten(t[2], axis);
  const Flat x = flatten(p, axis), y = flatten(q, axis);
  return in_triangle(x, a, b, c) || segments_meet(x, y, a, b) || segments_meet(x, y, b, c) || segments_meet(x, y, c, a);
}

bool meets_line(const Vec3& p, const Vec3& q, const Corners& t) {
  return segments_meet(p, q, t[0], t[1]) || segments_meet(p, q, t[1], t[2]) || segments_meet(p, q, t[2], t[0]);
}

/// Two triangles on both sides of a shared side, or folded onto each other.
bool overlap_at_side(const Vec3& s, const Vec3& t, const Vec3& a, const Vec3& b) {
  if (orient3d(s, t, a, b) != 0) return false;
  const int axis = clear_axis({s, t, a});
  if (axis < 0) return false;
  const Flat from = flatten(s, axis), to = flatten(t, axis);
  return turn(from, to, flatten(a, axis)) * turn(from, to, flatten(b, axis)) > 0;
}

bool lies_beside(const Corners& plane, const Corners& points, const std::array<bool, 3>& shared) {
  bool above = false, below = false;
  for (std::size_t i = 0; i < 3; ++i) {
    if (shared[i]) continue;
    const int side = orient3d(plane[0], plane[1], plane[2], points[i]);
    if (side == 0) return false;
    (side > 0 ? above : below) = true;
  }
  return above != below;
}

/// Which corners are shared.
struct Sharing {
  std::size_t count = 0;
  std::array<bool, 3> in_a{}, in_b{};
};

Sharing shared_corners(const Corners& a, const Corners& b) {
  Sharing sharing;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      if (sharing.in_a[i] || sharing.in_b[j] || a[i] != b[j]) continue;
      sharing.in_a[i] = sharing.in_b[j] = true;
      ++sharing.count;
    }
  }
  return sharing;
}

std::size_t index_of(const std::array<bool, 3>& flags, bool wanted) {
  return static_cast<std::size_t>(std::find(flags.begin(), flags.end(), wanted) - flags.begin());
}

}  // namespace

bool segment_meets_triangle(const Vec3& p, const Vec3& q, const Corners& t) {
  const int side_p = orient3d(t[0], t[1], t[2], p), side_q = orient3d(t[0], t[1], t[2], q);
  if (side_p * side_q > 0) return false;
  if (side_p == 0 && side_q == 0) {
    const int axis = clear_axis(t);
    return axis < 0 ? meets_line(p, q, t) : meets_in_plane(p, q, t, axis);
  }
  const int a = orient3d(p, q, t[0], t[1]), b = orient3d(p, q, t[1], t[2]), c = orient3d(p, q, t[2], t[0]);
  return (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0);
}

bool intersect_beyond_shared(const Corners& a, const Corners& b) {
  const Sharing sharing = shared_corners(a, b);
  if (sharing.count == 3) return true;
  if (sharing.count == 2) {
    const std::size_t i = index_of(sharing.in_a, false), j = index_of(sharing.in_b, false);
    return overlap_at_side(a[(i + 1) % 3], a[(i + 2) % 3], a[i], b[j]);
  }
  if (lies_beside(a, b, sharing.in_b) || lies_beside(b, a, sharing.in_a)) return false;
  if (sharing.count == 1) {
    // What they have in common besides the corner goes on to the side across from it, in the one or in the other.
    const std::size_t i = index_of(sharing.in_a, true), j = index_of(sharing.in_b, true);
    return segment_meets_triangle(a[(i + 1) % 3], a[(i + 2) % 3], b) ||
           segment_meets_triangle(b[(j + 1) % 3], b[(j + 2) % 3], a);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    if (segment_meets_triangle(a[i], a[(i + 1) % 3], b) || segment_meets_triangle(b[i], b[(i + 1) % 3], a)) return true;
  }
  return false;
}

}  // namespace limn
