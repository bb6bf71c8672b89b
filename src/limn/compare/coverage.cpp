#include "limn/compare/coverage.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <span>

#include "limn/base/parallel.h"

namespace limn {
namespace {

constexpr int kGridBits = 8;
constexpr std::int32_t kGrid = 1 << kGridBits;
constexpr std::int32_t kHalf = kGrid / 2;

// Projected points further out are clipped here, in pixels. 2^28 grid steps: differences fit 30 bits, edge
// functions 60.
constexpr double kGuard = 1 << 20;

// Marks a vertex that cannot be snapped because it lies behind the near plane or beyond the guard band.
constexpr std::int32_t kNeedsClipping = INT32_MIN;

// Triangles up to this many pixels wide are tested pixel by pixel; wider ones row by row, with divisions.
constexpr int kNarrow = 8;

struct GridPoint {
  std::int32_t x;
  std::int32_t y;
};

struct PixelPoint {
  double x;
  double y;
};

double dot(const DVec3& a, const DVec3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

DVec3 cross(const DVec3& a, const DVec3& b) {
  return DVec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

DVec3 unit(const DVec3& v) {
  return v / std::sqrt(dot(v, v));
}

// view_matrix() and projection_matrix() in double, so that coordinates of any size survive.
class Projection {
 public:
  Projection(const Camera& camera, int width, int height)
      : eye_(camera.eye), orthographic_(camera.orthographic), near_(camera.near_distance) {
    const DVec3 forward = unit(DVec3(camera.target) - eye_);
    DVec3 up(camera.up);
    const double up_length = std::sqrt(dot(up, up));
    if (up_length == 0.0 || std::abs(dot(forward, up)) > 0.9999 * up_length) {
      up = std::abs(forward.y) > 0.9 ? DVec3(0, 0, forward.y > 0 ? 1 : -1) : DVec3(0, 1, 0);
    }
    right_ = unit(cross(forward, up));
    up_ = cross(right_, forward);
    forward_ = forward;
    center_ = {0.5 * width, 0.5 * height};
    scale_ = orthographic_ ? height / static_cast<double>(camera.ortho_height)
                           : 0.5 * height / std::tan(0.5 * static_cast<double>(camera.fov_rad));
  }

  /// x to the right, y upwards, z the depth in front of the eye.
  DVec3 to_eye_space(const Vec3& p) const {
    const DVec3 d = DVec3(p) - eye_;
    return DVec3(dot(right_, d), dot(up_, d), dot(forward_, d));
  }

  bool in_front(const DVec3& e) const { return orthographic_ || e.z >= near_; }
  double near_distance() const { return near_; }

  /// \pre in_front(e)
  PixelPoint to_pixels(const DVec3& e) const {
    const double s = orthographic_ ? scale_ : scale_ / e.z;
    return {center_.x + s * e.x, center_.y - s * e.y};
  }

 private:
  DVec3 eye_, right_, up_, forward_;
  PixelPoint center_{};
  double scale_ = 1;
  bool orthographic_;
  double near_;
};

bool in_guard_band(const PixelPoint& p) {
  return std::abs(p.x) <= kGuard && std::abs(p.y) <= kGuard;
}

// Rounds to the nearest grid line, ties upwards. The offset makes truncation a floor.
std::int32_t snap(double pixels) {
  constexpr double kOffset = kGuard * kGrid * 2;
  return static_cast<std::int32_t>(pixels * kGrid + (kOffset + 0.5)) - static_cast<std::int32_t>(kOffset);
}

GridPoint snap(const PixelPoint& p) {
  return {snap(p.x), snap(p.y)};
}

std::vector<GridPoint> project_vertices(std::span<const Vec3> positions, const Projection& projection) {
  std::vector<GridPoint> points(positions.size());
  parallel_for(positions.size(), 16384, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const DVec3 e = projection.to_eye_space(positions[i]);
      points[i] = {kNeedsClipping, 0};
      if (!projection.in_front(e)) continue;
      const PixelPoint p = projection.to_pixels(e);
      if (in_guard_band(p)) points[i] = snap(p);
    }
  });
  return points;
}

// One bit a pixel; every thread draws into its own.
class Bitmap {
 public:
  Bitmap(int width, int height)
      : width_(width),
        height_(height),
        row_words_((static_cast<std::size_t>(width) + 63) / 64),
        words_(row_words_ * static_cast<std::size_t>(height)) {}

  int width() const { return width_; }
  int height() const { return height_; }
  std::span<const std::uint64_t> row(int y) const { return {words_.data() + row_start(y), row_words_}; }

  /// Sets the pixels x + i for the bits i of mask. \pre those pixels lie in the row
  void set_bits(int x, int y, std::uint32_t mask) {
    std::uint64_t* word = words_.data() + row_start(y) + x / 64;
    const int shift = x % 64;
    word[0] |= static_cast<std::uint64_t>(mask) << shift;
    if (shift > 32 && (mask >> (64 - shift)) != 0) word[1] |= static_cast<std::uint64_t>(mask) >> (64 - shift);
  }

  /// Sets pixels first … last. \pre 0 <= first <= last < width
  void set_span(int first, int last, int y) {
    std::uint64_t* words = words_.data() + row_start(y);
    const int first_word = first / 64;
    const int last_word = last / 64;
    const std::uint64_t head = ~std::uint64_t{0} << (first % 64);
    const std::uint64_t tail = ~std::uint64_t{0} >> (63 - last % 64);
    if (first_word == last_word) {
      words[first_word] |= head & tail;
      return;
    }
    words[first_word] |= head;
    std::fill(words + first_word + 1, words + last_word, ~std::uint64_t{0});
    words[last_word] |= tail;
  }

 private:
  std::size_t row_start(int y) const { return row_words_ * static_cast<std::size_t>(y); }

  int width_, height_;
  std::size_t row_words_;
  std::vector<std::uint64_t> words_;
};

// One edge's function at pixel (x0, y0), and its steps; a pixel centre is inside where it is not negative.
struct EdgeFunction {
  std::int64_t value, step_x, step_y;
};

EdgeFunction edge_function(const GridPoint& a, const GridPoint& b, int x0, int y0) {
  const std::int64_t dx = std::int64_t{b.x} - a.x;
  const std::int64_t dy = std::int64_t{b.y} - a.y;
  const std::int64_t px = std::int64_t{x0} * kGrid + kHalf - a.x;
  const std::int64_t py = std::int64_t{y0} * kGrid + kHalf - a.y;
  const bool top_left = dy < 0 || (dy == 0 && dx > 0);
  return {dx * py - dy * px - (top_left ? 0 : 1), -dy * kGrid, dx * kGrid};
}

std::int64_t floor_divide(std::int64_t a, std::int64_t b) {
  const std::int64_t quotient = a / b;
  return quotient * b > a ? quotient - 1 : quotient;
}

// \pre b > 0 in both
std::int64_t ceil_divide(std::int64_t a, std::int64_t b) {
  return -floor_divide(-a, b);
}

void fill_narrow(Bitmap& bitmap, std::array<EdgeFunction, 3> e, int x0, int x1, int y0, int y1) {
  for (int y = y0; y <= y1; ++y) {
    std::int64_t a = e[0].value, b = e[1].value, c = e[2].value;
    std::uint32_t mask = 0;
    for (int i = 0; i <= x1 - x0; ++i) {
      if ((a | b | c) >= 0) mask |= std::uint32_t{1} << i;
      a += e[0].step_x;
      b += e[1].step_x;
      c += e[2].step_x;
    }
    if (mask != 0) bitmap.set_bits(x0, y, mask);
    for (EdgeFunction& edge : e)
      edge.value += edge.step_y;
  }
}

void fill_wide(Bitmap& bitmap, std::array<EdgeFunction, 3> e, int x0, int x1, int y0, int y1) {
  for (int y = y0; y <= y1; ++y) {
    std::int64_t first = 0;
    std::int64_t last = x1 - x0;
    for (EdgeFunction& edge : e) {
      if (edge.step_x > 0) {
        first = std::max(first, ceil_divide(-edge.value, edge.step_x));
      } else if (edge.step_x < 0) {
        last = std::min(last, floor_divide(edge.value, -edge.step_x));
      } else if (edge.value < 0) {
        last = -1;
      }
      edge.value += edge.step_y;
    }
    if (first <= last) bitmap.set_span(x0 + static_cast<int>(first), x0 + static_cast<int>(last), y);
  }
}

void fill_triangle(Bitmap& bitmap, GridPoint a, GridPoint b, GridPoint c) {
  // The pixels whose centres lie in the triangle's box: most triangles of a dense mesh have none.
  const int x0 = std::max((std::min({a.x, b.x, c.x}) + kHalf - 1) >> kGridBits, 0);
  const int x1 = std::min((std::max({a.x, b.x, c.x}) - kHalf) >> kGridBits, bitmap.width() - 1);
  const int y0 = std::max((std::min({a.y, b.y, c.y}) + kHalf - 1) >> kGridBits, 0);
  const int y1 = std::min((std::max({a.y, b.y, c.y}) - kHalf) >> kGridBits, bitmap.height() - 1);
  if (x0 > x1 || y0 > y1) return;
  const std::int64_t area = (std::int64_t{b.x} - a.x) * (std::int64_t{c.y} - a.y) -  //
                            (std::int64_t{b.y} - a.y) * (std::int64_t{c.x} - a.x);
  if (area == 0) return;
  if (area < 0) std::swap(b, c);
  const std::array<EdgeFunction, 3> edges = {edge_function(a, b, x0, y0), edge_function(b, c, x0, y0),
                                             edge_function(c, a, x0, y0)};
  if (x1 - x0 < kNarrow) {
    fill_narrow(bitmap, edges, x0, x1, y0, y1);
  } else {
    fill_wide(bitmap, edges, x0, x1, y0, y1);
  }
}

// Cuts a convex polygon at a plane, keeping what lies inside. New points are computed from the inner end towards the
// outer one, so two triangles that share an edge get the same point. `distance` is not negative inside; `cut(in, out,
// t)` gives the point at share t of the way.
template <class Point, class Distance, class Cut>
void clip_polygon(std::vector<Point>& polygon, const Distance& distance, const Cut& cut) {
  std::vector<Point> kept;
  kept.reserve(polygon.size() + 1);
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point& p = polygon[i];
    const Point& q = polygon[(i + 1) % polygon.size()];
    const double at_p = distance(p);
    const double at_q = distance(q);
    if (at_p >= 0) kept.push_back(p);
    if (at_p >= 0 && at_q < 0) kept.push_back(cut(p, q, at_p / (at_p - at_q)));
    if (at_p < 0 && at_q >= 0) kept.push_back(cut(q, p, at_q / (at_q - at_p)));
  }
  polygon = std::move(kept);
}

void clip_to_guard_band(std::vector<PixelPoint>& polygon) {
  for (const double side : {-1.0, 1.0}) {
    clip_polygon(
        polygon, [&](const PixelPoint& p) { return kGuard - side * p.x; },
        [&](const PixelPoint& in, const PixelPoint& out, double t) {
          return PixelPoint{side * kGuard, in.y + t * (out.y - in.y)};
        });
    clip_polygon(
        polygon, [&](const PixelPoint& p) { return kGuard - side * p.y; },
        [&](const PixelPoint& in, const PixelPoint& out, double t) {
          return PixelPoint{in.x + t * (out.x - in.x), side * kGuard};
        });
  }
}

// Nothing but rounding lies outside the guard band after clipping.
GridPoint snap_clipped(const PixelPoint& p) {
  return snap(PixelPoint{std::clamp(p.x, -kGuard, kGuard), std::clamp(p.y, -kGuard, kGuard)});
}

void fill_clipped(Bitmap& bitmap, const Projection& projection, const std::array<Vec3, 3>& corners) {
  std::vector<DVec3> in_eye_space;
  for (const Vec3& corner : corners) {
    if (!is_finite(corner)) return;
    in_eye_space.push_back(projection.to_eye_space(corner));
  }
  const double near = projection.near_distance();
  const auto in_front = [&](const DVec3& e) { return projection.in_front(e); };
  if (!std::all_of(in_eye_space.begin(), in_eye_space.end(), in_front)) {
    clip_polygon(
        in_eye_space, [&](const DVec3& e) { return e.z - near; },
        [&](const DVec3& in, const DVec3& out, double t) {
          return DVec3(in.x + t * (out.x - in.x), in.y + t * (out.y - in.y), near);
        });
  }
  std::vector<PixelPoint> polygon;
  for (const DVec3& e : in_eye_space) {
    polygon.push_back(projection.to_pixels(e));
    if (!std::isfinite(polygon.back().x) || !std::isfinite(polygon.back().y)) return;
  }
  clip_to_guard_band(polygon);
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    fill_triangle(bitmap, snap_clipped(polygon[0]), snap_clipped(polygon[i - 1]), snap_clipped(polygon[i]));
  }
}

void fill_faces(Bitmap& bitmap, const Mesh& mesh, const Projection& projection, std::span<const GridPoint> points,
                std::size_t begin, std::size_t end) {
  for (std::size_t f = begin; f < end; ++f) {
    const Triangle& face = mesh.faces[f];
    const GridPoint a = points[face[0]];
    const GridPoint b = points[face[1]];
    const GridPoint c = points[face[2]];
    if (a.x == kNeedsClipping || b.x == kNeedsClipping || c.x == kNeedsClipping) {
      fill_clipped(bitmap, projection, {mesh.positions[face[0]], mesh.positions[face[1]], mesh.positions[face[2]]});
    } else {
      fill_triangle(bitmap, a, b, c);
    }
  }
}

Coverage merge(const std::vector<Bitmap>& bitmaps) {
  Coverage coverage(bitmaps.front().width(), bitmaps.front().height());
  parallel_for(static_cast<std::size_t>(coverage.height), 64, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint64_t> merged;
    for (std::size_t y = begin; y < end; ++y) {
      merged.assign(bitmaps.front().row(static_cast<int>(y)).size(), 0);
      for (const Bitmap& bitmap : bitmaps) {
        const std::span<const std::uint64_t> row = bitmap.row(static_cast<int>(y));
        for (std::size_t i = 0; i < row.size(); ++i)
          merged[i] |= row[i];
      }
      std::uint8_t* out = coverage.covered.data() + y * static_cast<std::size_t>(coverage.width);
      for (std::size_t x = 0; x < static_cast<std::size_t>(coverage.width); ++x) {
        out[x] = static_cast<std::uint8_t>(merged[x / 64] >> (x % 64) & 1);
      }
    }
  });
  return coverage;
}

}  // namespace

Coverage rasterize_coverage(const Mesh& mesh, const Camera& camera, int width, int height) {
  assert(width >= 1 && width <= kMaxCoverageSize && height >= 1 && height <= kMaxCoverageSize);
  const Projection projection(camera, width, height);
  const std::vector<GridPoint> points = project_vertices(mesh.positions, projection);
  // Coverage is a union, so the number of parts, one a thread, leaves no trace in the result.
  const std::size_t wanted_parts = mesh.faces.size() / 4096;
  const std::size_t parts = std::clamp<std::size_t>(wanted_parts, 1, static_cast<std::size_t>(thread_count()));
  std::vector<Bitmap> bitmaps(parts, Bitmap(width, height));
  parallel_for(parts, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t part = begin; part < end; ++part) {
      fill_faces(bitmaps[part], mesh, projection, points, part * mesh.faces.size() / parts,
                 (part + 1) * mesh.faces.size() / parts);
    }
  });
  return merge(bitmaps);
}

}  // namespace limn
