#include "support/winding.h"

#include <algorithm>
#include <cmath>

#include "support/exact.h"

namespace limn::test {
namespace {

/// The turn of a, b, point, the point moved by (ε, ε²): 0 only where a and b fall together seen along z.
int moved_turn(const DVec3& a, const DVec3& b, const DVec3& point) {
  const int turn = exact_turn(a, b, point);
  if (turn != 0) return turn;
  if (a.y != b.y) return a.y > b.y ? 1 : -1;
  return a.x == b.x ? 0 : b.x > a.x ? 1 : -1;
}

bool is_between(double a, double b, double c, double x) {
  return std::min({a, b, c}) <= x && x <= std::max({a, b, c});
}

}  // namespace

Winding::Winding(std::span<const Vec3> positions, std::span<const Triangle> faces) {
  for (const Triangle& t : faces)
    faces_.push_back({DVec3(positions[t[0]]), DVec3(positions[t[1]]), DVec3(positions[t[2]])});
  if (faces_.empty()) return;
  low_ = high_ = faces_[0].a;
  for (const Face& face : faces_) {
    for (const DVec3& p : {face.a, face.b, face.c}) {
      low_ = glm::min(low_, p);
      high_ = glm::max(high_, p);
    }
  }
  columns_ = 1 + static_cast<std::size_t>(std::sqrt(static_cast<double>(faces_.size())));
  begin_.assign(columns_ * columns_ + 2, 0);
  const auto for_each_cell = [&](const Face& face, auto visit) {
    const std::size_t x0 = column(std::min({face.a.x, face.b.x, face.c.x}), 0);
    const std::size_t x1 = column(std::max({face.a.x, face.b.x, face.c.x}), 0);
    const std::size_t y0 = column(std::min({face.a.y, face.b.y, face.c.y}), 1);
    const std::size_t y1 = column(std::max({face.a.y, face.b.y, face.c.y}), 1);
    for (std::size_t y = y0; y <= y1; ++y) {
      for (std::size_t x = x0; x <= x1; ++x)
        visit(y * columns_ + x);
    }
  };
  for (const Face& face : faces_)
    for_each_cell(face, [&](std::size_t cell) { ++begin_[cell + 2]; });
  for (std::size_t i = 2; i < begin_.size(); ++i)
    begin_[i] += begin_[i - 1];
  listed_.resize(begin_.back());
  for (std::uint32_t i = 0; i < faces_.size(); ++i)
    for_each_cell(faces_[i], [&](std::size_t cell) { listed_[begin_[cell + 1]++] = i; });
}

/// Never falls as x grows, so that a point's column lies among those of every face around it.
std::size_t Winding::column(double x, int axis) const {
  const double share = (x - low_[axis]) / (high_[axis] - low_[axis]);
  if (!(share > 0)) return 0;
  return std::min(columns_ - 1, static_cast<std::size_t>(share * static_cast<double>(columns_)));
}

std::span<const std::uint32_t> Winding::faces_above(const DVec3& point) const {
  if (faces_.empty() || point.x < low_.x || point.x > high_.x || point.y < low_.y || point.y > high_.y) return {};
  const std::size_t cell = column(point.y, 1) * columns_ + column(point.x, 0);
  return std::span(listed_).subspan(begin_[cell], begin_[cell + 1] - begin_[cell]);
}

bool Winding::is_on_surface(const DVec3& point) const {
  for (const std::uint32_t i : faces_above(point)) {
    const auto& [a, b, c] = faces_[i];
    if (!is_between(a.x, b.x, c.x, point.x) || !is_between(a.y, b.y, c.y, point.y) ||
        !is_between(a.z, b.z, c.z, point.z))
      continue;
    if (exact_side(a, b, c, point) != 0) continue;
    // In its plane: within it, if so seen along all three axes.
    bool within = true;
    for (int axis = 0; axis < 3 && within; ++axis) {
      const auto flat = [axis](const DVec3& p) { return DVec3(p[(axis + 1) % 3], p[(axis + 2) % 3], 0); };
      const int ab = exact_turn(flat(a), flat(b), flat(point));
      const int bc = exact_turn(flat(b), flat(c), flat(point));
      const int ca = exact_turn(flat(c), flat(a), flat(point));
      within = (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
    }
    if (within) return true;
  }
  return false;
}

int Winding::at(const DVec3& point) const {
  int winding = 0;
  for (const std::uint32_t i : faces_above(point)) {
    const auto& [a, b, c] = faces_[i];
    if (!is_between(a.x, b.x, c.x, point.x) || !is_between(a.y, b.y, c.y, point.y)) continue;
    if (std::max({a.z, b.z, c.z}) < point.z) continue;
    const int ab = moved_turn(a, b, point);
    if (ab == 0 || moved_turn(b, c, point) != ab || moved_turn(c, a, point) != ab) continue;
    if (exact_side(a, b, c, point) * ab < 0) winding += ab;
  }
  return winding;
}

}  // namespace limn::test
