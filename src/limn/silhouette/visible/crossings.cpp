#include "limn/silhouette/visible/crossings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "limn/base/parallel.h"

namespace limn {
namespace {

constexpr double kTie = 1e-9;         // of a segment's length
constexpr double kFlat = 1e-12;       // sine below which two segments overlap along a line
constexpr std::size_t kCrowded = 16;  // segments in a cell that are worth cutting it
constexpr int kDeepest = 12;          // cuts of a cell
constexpr double kCellsPerSegment = 4;
constexpr double kWidestCone = 2.0;  // tangent of the half angle up to which one picture plane holds everything

/// A segment as seen from the eye. For a parallel projection (x, y, 1) in the picture: then the same determinants
/// apply.
struct Seen {
  DVec3 a, ab;   ///< direction to a; to b less that to a
  DVec3 across;  ///< a × ab: normal to the plane through the eye and the segment
  double across_length = 0;
  double depth_a = 0, depth_b = 0;  ///< parallel only: larger is nearer
};

struct Point2 {
  double x, y;
};

/// A segment, or a part of one, within one picture plane.
struct Flat {
  Point2 a, b;
  std::uint32_t segment;
};

struct Box {
  double low_x, low_y, high_x, high_y;
};

/// Right, up and towards the viewer: orthonormal.
struct Axes {
  DVec3 x, y, z;
};

Axes axes_of(const DVec3& towards_viewer) {
  const double size = std::max({std::abs(towards_viewer.x), std::abs(towards_viewer.y), std::abs(towards_viewer.z)});
  const DVec3 z = glm::normalize(towards_viewer / size);
  const DVec3 other = std::abs(z.x) < 0.6 ? DVec3(1, 0, 0) : DVec3(0, 1, 0);
  const DVec3 x = glm::normalize(glm::cross(other, z));
  return {x, glm::cross(z, x), z};
}

class Finder {
 public:
  Finder(std::span<const Segment> segments, const Eye& eye, bool behind)
      : segments_(segments), orthographic_(eye.orthographic), behind_(behind), seen_(segments.size()) {
    bound_segments();
    if (orthographic_) axes_ = axes_of(DVec3(eye.at));
    parallel_for(segments.size(), 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        seen_[i] = see(segments_[i], eye);
    });
  }

  std::vector<Crossing> find(const Eye& eye) {
    if (segments_.empty() || !(scale_ > 0.0)) return {};
    if (orthographic_) {
      search(flat_parallel());
    } else if (const std::optional<Axes> axes = one_plane(eye)) {
      search(flat_cone(*axes, false));
    } else {
      for (const DVec3& z :
           {DVec3(1, 0, 0), DVec3(-1, 0, 0), DVec3(0, 1, 0), DVec3(0, -1, 0), DVec3(0, 0, 1), DVec3(0, 0, -1)})
        search(flat_cone(axes_of(z), true));
    }
    std::sort(found_.begin(), found_.end(), [](const Crossing& a, const Crossing& b) {
      if (a.segment != b.segment) return a.segment < b.segment;
      return a.t != b.t ? a.t < b.t : a.in_front < b.in_front;
    });
    found_.erase(std::unique(found_.begin(), found_.end(),
                             [](const Crossing& a, const Crossing& b) {
                               return a.segment == b.segment && a.t == b.t && a.in_front == b.in_front;
                             }),
                 found_.end());
    return std::move(found_);
  }

 private:
  void bound_segments() {
    DVec3 low(1e300), high(-1e300);
    for (const Segment& s : segments_) {
      low = glm::min(low, glm::min(s.a, s.b));
      high = glm::max(high, glm::max(s.a, s.b));
    }
    middle_ = (low + high) * 0.5;
    radius_ = 0.5 * glm::length(high - low);
    scale_ = radius_ > 0.0 ? 1.0 / radius_ : 0.0;
  }

  Seen see(const Segment& s, const Eye& eye) const {
    Seen seen;
    const DVec3 ab = (s.b - s.a) * scale_;
    if (orthographic_) {
      const DVec3 a = (s.a - middle_) * scale_;
      seen.a = DVec3(glm::dot(a, axes_.x), glm::dot(a, axes_.y), 1.0);
      seen.ab = DVec3(glm::dot(ab, axes_.x), glm::dot(ab, axes_.y), 0.0);
      seen.depth_a = glm::dot(a, axes_.z);
      seen.depth_b = seen.depth_a + glm::dot(ab, axes_.z);
    } else {
      seen.a = (s.a - DVec3(eye.at)) * scale_;
      seen.ab = ab;
    }
    seen.across = glm::cross(seen.a, seen.ab);
    seen.across_length = glm::length(seen.across);
    return seen;
  }

  /// The plane across the line from the eye to the segments' middle, where all of them lie within a cone about it.
  std::optional<Axes> one_plane(const Eye& eye) const {
    const DVec3 away = DVec3(eye.at) - middle_;
    const double distance = glm::length(away);
    if (distance * distance < radius_ * radius_ * (1.0 + 1.0 / (kWidestCone * kWidestCone))) return std::nullopt;
    return axes_of(away);
  }

  std::vector<Flat> flat_parallel() const {
    std::vector<Flat> flats(seen_.size());
    for (std::uint32_t i = 0; i < seen_.size(); ++i) {
      const Seen& s = seen_[i];
      flats[i] = {{s.a.x, s.a.y}, {s.a.x + s.ab.x, s.a.y + s.ab.y}, i};
    }
    return flats;
  }

  /// Segments projected to the plane at distance 1; when `clip`, what of them lies in the square pyramid about it.
  std::vector<Flat> flat_cone(const Axes& axes, bool clip) const {
    std::vector<Flat> flats;
    flats.reserve(seen_.size());
    for (std::uint32_t i = 0; i < seen_.size(); ++i) {
      const auto rotated = [&axes](const DVec3& p) {
        return DVec3(glm::dot(p, axes.x), glm::dot(p, axes.y), -glm::dot(p, axes.z));
      };
      const DVec3 a = rotated(seen_[i].a), ab = rotated(seen_[i].ab);
      double from = 0.0, to = 1.0;
      if (clip && !clip_to_pyramid(a, ab, from, to)) continue;
      const DVec3 p = a + ab * from, q = a + ab * to;
      if (!(p.z > 0.0 && q.z > 0.0)) continue;
      flats.push_back({{p.x / p.z, p.y / p.z}, {q.x / q.z, q.y / q.z}, i});
    }
    return flats;
  }

  /// A little more than a sixth of the sphere, so that nothing on the rim is lost.
  static bool clip_to_pyramid(const DVec3& a, const DVec3& ab, double& from, double& to) {
    constexpr double kWider = 1.0 + 1e-6;
    for (const DVec3& side : {DVec3(1, 0, kWider), DVec3(-1, 0, kWider), DVec3(0, 1, kWider), DVec3(0, -1, kWider)}) {
      const double at = glm::dot(side, a), step = glm::dot(side, ab);
      if (at < 0.0 && at + step < 0.0) return false;
      if (at < 0.0) from = std::max(from, -at / step);
      if (at + step < 0.0) to = std::min(to, -at / step);
    }
    return from < to;
  }

  void search(const std::vector<Flat>& flats) {
    if (flats.empty()) return;
    lay_grid(flats);
    std::vector<std::vector<Crossing>> rows(rows_);
    parallel_for(rows_, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t row = begin; row < end; ++row) {
        for (std::size_t column = 0; column < columns_; ++column) {
          const std::size_t cell = row * columns_ + column;
          const std::span<const std::uint32_t> items(items_.data() + offsets_[cell],
                                                     items_.data() + offsets_[cell + 1]);
          search_cell(flats, items, cell_box(row, column), 0, rows[row]);
        }
      }
    });
    for (const std::vector<Crossing>& row : rows)
      found_.insert(found_.end(), row.begin(), row.end());
  }

  Box cell_box(std::size_t row, std::size_t column) const {
    const double x = grid_.low_x + cell_x_ * static_cast<double>(column);
    const double y = grid_.low_y + cell_y_ * static_cast<double>(row);
    return {x, y, x + cell_x_, y + cell_y_};
  }

  /// Sorts the segments into a grid of about kCellsPerSegment cells each, by counting.
  void lay_grid(const std::vector<Flat>& flats) {
    grid_ = {1e300, 1e300, -1e300, -1e300};
    for (const Flat& f : flats) {
      grid_.low_x = std::min({grid_.low_x, f.a.x, f.b.x});
      grid_.low_y = std::min({grid_.low_y, f.a.y, f.b.y});
      grid_.high_x = std::max({grid_.high_x, f.a.x, f.b.x});
      grid_.high_y = std::max({grid_.high_y, f.a.y, f.b.y});
    }
    const double margin = 1e-9 * (grid_.high_x - grid_.low_x + grid_.high_y - grid_.low_y) + 1e-300;
    grid_ = {grid_.low_x - margin, grid_.low_y - margin, grid_.high_x + margin, grid_.high_y + margin};
    const double width = grid_.high_x - grid_.low_x, height = grid_.high_y - grid_.low_y;
    const double cells = std::min(kCellsPerSegment * static_cast<double>(flats.size()), 4e6);
    columns_ = static_cast<std::size_t>(std::clamp(std::sqrt(cells * width / height), 1.0, cells));
    rows_ = static_cast<std::size_t>(std::clamp(cells / static_cast<double>(columns_), 1.0, cells));
    cell_x_ = width / static_cast<double>(columns_);
    cell_y_ = height / static_cast<double>(rows_);
    offsets_.assign(rows_ * columns_ + 1, 0);
    for (const Flat& f : flats)
      for_cells(f, [&](std::size_t cell) { ++offsets_[cell + 1]; });
    for (std::size_t cell = 0; cell < rows_ * columns_; ++cell)
      offsets_[cell + 1] += offsets_[cell];
    items_.resize(offsets_.back());
    std::vector<std::uint32_t> next(offsets_.begin(), offsets_.end() - 1);
    for (std::uint32_t i = 0; i < flats.size(); ++i)
      for_cells(flats[i], [&](std::size_t cell) { items_[next[cell]++] = i; });
  }

  template <class Body>
  void for_cells(const Flat& f, const Body& body) const {
    const auto index = [](double at, double low, double size, std::size_t count) {
      return static_cast<std::size_t>(std::clamp((at - low) / size, 0.0, static_cast<double>(count - 1)));
    };
    const double slack_x = 1e-6 * cell_x_, slack_y = 1e-6 * cell_y_;
    const std::size_t left = index(std::min(f.a.x, f.b.x) - slack_x, grid_.low_x, cell_x_, columns_);
    const std::size_t right = index(std::max(f.a.x, f.b.x) + slack_x, grid_.low_x, cell_x_, columns_);
    const std::size_t low = index(std::min(f.a.y, f.b.y) - slack_y, grid_.low_y, cell_y_, rows_);
    const std::size_t high = index(std::max(f.a.y, f.b.y) + slack_y, grid_.low_y, cell_y_, rows_);
    const bool narrow = left == right || low == high;
    for (std::size_t row = low; row <= high; ++row) {
      for (std::size_t column = left; column <= right; ++column) {
        if (narrow || touches(f, cell_box(row, column))) body(row * columns_ + column);
      }
    }
  }

  /// Whether the segment's line comes within a hair of the box. \pre their bounding boxes overlap
  static bool touches(const Flat& f, const Box& box) {
    const double nx = f.b.y - f.a.y, ny = f.a.x - f.b.x;
    const double center_x = 0.5 * (box.low_x + box.high_x), center_y = 0.5 * (box.low_y + box.high_y);
    const double reach = std::abs(nx) * (box.high_x - box.low_x) + std::abs(ny) * (box.high_y - box.low_y);
    return std::abs(nx * (center_x - f.a.x) + ny * (center_y - f.a.y)) <= 0.500001 * reach;
  }

  static bool overlaps(const Flat& f, const Box& box) {
    const double slack_x = 1e-6 * (box.high_x - box.low_x), slack_y = 1e-6 * (box.high_y - box.low_y);
    return std::max(f.a.x, f.b.x) >= box.low_x - slack_x && std::min(f.a.x, f.b.x) <= box.high_x + slack_x &&
           std::max(f.a.y, f.b.y) >= box.low_y - slack_y && std::min(f.a.y, f.b.y) <= box.high_y + slack_y &&
           touches(f, box);
  }

  void search_cell(const std::vector<Flat>& flats, std::span<const std::uint32_t> items, const Box& box, int depth,
                   std::vector<Crossing>& found) const {
    if (items.size() < 2) return;
    if (items.size() <= kCrowded || depth == kDeepest) return compare_all(flats, items, found);
    const double x = 0.5 * (box.low_x + box.high_x), y = 0.5 * (box.low_y + box.high_y);
    const Box quarters[4] = {{box.low_x, box.low_y, x, y},
                             {x, box.low_y, box.high_x, y},
                             {box.low_x, y, x, box.high_y},
                             {x, y, box.high_x, box.high_y}};
    std::array<std::vector<std::uint32_t>, 4> parts;
    std::size_t total = 0;
    for (std::size_t q = 0; q < 4; ++q) {
      for (const std::uint32_t i : items) {
        if (overlaps(flats[i], quarters[q])) parts[q].push_back(i);
      }
      total += parts[q].size();
    }
    // Segments through one point cannot be told apart by cutting.
    if (total > 3 * items.size()) return compare_all(flats, items, found);
    for (std::size_t q = 0; q < 4; ++q)
      search_cell(flats, parts[q], quarters[q], depth + 1, found);
  }

  void compare_all(const std::vector<Flat>& flats, std::span<const std::uint32_t> items,
                   std::vector<Crossing>& found) const {
    for (std::size_t i = 0; i < items.size(); ++i) {
      const Flat& f = flats[items[i]];
      const double low_x = std::min(f.a.x, f.b.x), high_x = std::max(f.a.x, f.b.x);
      const double low_y = std::min(f.a.y, f.b.y), high_y = std::max(f.a.y, f.b.y);
      const double slack = 1e-8 * (high_x - low_x + high_y - low_y);
      for (std::size_t j = i + 1; j < items.size(); ++j) {
        const Flat& g = flats[items[j]];
        if (std::max(g.a.x, g.b.x) < low_x - slack || std::min(g.a.x, g.b.x) > high_x + slack ||
            std::max(g.a.y, g.b.y) < low_y - slack || std::min(g.a.y, g.b.y) > high_y + slack)
          continue;
        compare(f.segment, g.segment, found);
      }
    }
  }

  void compare(std::uint32_t i, std::uint32_t j, std::vector<Crossing>& found) const {
    if (i > j) std::swap(i, j);
    const Segment &p = segments_[i], &q = segments_[j];
    if (!(p.line && q.edge) && !(q.line && p.edge)) return;
    for (const VertexId v : p.ends) {
      if (v == q.ends[0] || v == q.ends[1]) return;
    }
    const Seen &a = seen_[i], &c = seen_[j];
    // Sides of c's ends from the plane through the eye and a, and the other way round.
    const DVec3 between = c.a - a.a;
    const double c0 = glm::dot(a.across, between), turn_c = -glm::dot(a.across, c.ab);
    const double a0 = -glm::dot(c.across, between), turn_a = -glm::dot(c.across, a.ab);
    const double flat = kFlat * a.across_length * c.across_length;
    if (turn_c * turn_c * glm::dot(c.a, c.a) <= flat * flat || turn_a * turn_a * glm::dot(a.a, a.a) <= flat * flat) {
      if (std::abs(c0) <= kTie * a.across_length * glm::length(c.ab)) overlap(i, j, found);
      return;
    }
    const double s = a0 / turn_a, t = c0 / turn_c;
    if (s < -kTie || s > 1.0 + kTie || t < -kTie || t > 1.0 + kTie) return;
    report(i, s, j, t, found);
  }

  /// Segments along one line of the picture: each is cut where the other's ends lie.
  void overlap(std::uint32_t i, std::uint32_t j, std::vector<Crossing>& found) const {
    for (const bool swapped : {false, true}) {
      const std::uint32_t cut = swapped ? j : i, by = swapped ? i : j;
      if (!segments_[cut].line || !segments_[by].edge) continue;
      const Seen &a = seen_[cut], &c = seen_[by];
      const double length = glm::dot(a.ab, a.ab);
      for (const DVec3& end : {c.a, c.a + c.ab}) {
        // Where the line of sight to `end` comes nearest to the segment, both within one plane through the eye.
        const DVec3 normal = orthographic_ ? DVec3(a.ab.x, a.ab.y, 0) : glm::cross(end, a.across);
        const double slope = glm::dot(normal, a.ab);
        if (!(length > 0.0) || slope == 0.0) continue;
        const double t = orthographic_ ? glm::dot(normal, end - a.a) / slope : -glm::dot(normal, a.a) / slope;
        if (t >= -kTie && t <= 1.0 + kTie) found.push_back({cut, std::clamp(t, 0.0, 1.0), true});
      }
    }
  }

  void report(std::uint32_t i, double s, std::uint32_t j, double t, std::vector<Crossing>& found) const {
    const Seen &a = seen_[i], &c = seen_[j];
    double i_nearer = 0;  // positive: segment i is the nearer one
    if (orthographic_) {
      i_nearer = (a.depth_a + s * (a.depth_b - a.depth_a)) - (c.depth_a + t * (c.depth_b - c.depth_a));
    } else {
      const DVec3 p = a.a + s * a.ab, q = c.a + t * c.ab;
      if (glm::dot(p, q) < 0.0) return;  // on opposite sides of the eye
      i_nearer = glm::length(q) - glm::length(p);
    }
    constexpr double kEquallyNear = 1e-9;
    const auto add = [&](std::uint32_t segment, double at, bool in_front) {
      if (in_front || behind_) found.push_back({segment, std::clamp(at, 0.0, 1.0), in_front});
    };
    if (segments_[i].line && segments_[j].edge) add(i, s, i_nearer <= kEquallyNear);
    if (segments_[j].line && segments_[i].edge) add(j, t, i_nearer >= -kEquallyNear);
  }

  std::span<const Segment> segments_;
  bool orthographic_;
  bool behind_;
  DVec3 middle_{0};
  double radius_ = 0, scale_ = 0;
  Axes axes_{};
  std::vector<Seen> seen_;
  std::vector<Crossing> found_;
  Box grid_{};
  std::size_t rows_ = 0, columns_ = 0;
  double cell_x_ = 0, cell_y_ = 0;
  std::vector<std::uint32_t> offsets_, items_;
};

}  // namespace

std::vector<Crossing> find_crossings(std::span<const Segment> segments, const Eye& eye, bool behind) {
  return Finder(segments, eye, behind).find(eye);
}

}  // namespace limn
