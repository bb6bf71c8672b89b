#include "limn/drawing/overlap.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

namespace limn::drawing {
namespace {

using DVec2 = glm::dvec2;

/// Sine of the angle below which pieces run along one another: keeps short pieces that cross a line.
constexpr double kParallel = 0.1;

/// A piece and the square of the grid it touches.
struct Entry {
  std::uint64_t cell;
  std::uint32_t piece;

  bool operator<(const Entry& other) const { return cell != other.cell ? cell < other.cell : piece < other.piece; }
};

/// A part of a piece that another lies on, in steps from its start.
struct Cover {
  std::uint32_t piece;
  double from;
  double to;

  bool operator<(const Cover& other) const { return piece != other.piece ? piece < other.piece : from < other.from; }
};

class Overlaps {
 public:
  Overlaps(const std::vector<Piece>& pieces, Nodes& nodes, double tolerance_steps)
      : pieces_(pieces), nodes_(nodes), tolerance_(tolerance_steps) {
    along_.reserve(pieces.size());
    for (const Piece& piece : pieces)
      along_.push_back(at(piece.b) - at(piece.a));
  }

  std::vector<Piece> remove() {
    enter_into_grid();
    find_covers();
    return cut();
  }

 private:
  DVec2 at(NodeId node) const { return DVec2(nodes_[node]); }

  /// The side of the grid's squares: the mean length, so that pieces enter three squares or so each.
  double cell_size() const {
    double length = 0.0;
    for (const DVec2& along : along_)
      length += glm::length(along);
    return std::max(length / double(std::max<std::size_t>(pieces_.size(), 1)), 8.0 * tolerance_);
  }

  void enter_into_grid() {
    const double cell = cell_size();
    const auto row = [cell](double value) { return static_cast<std::int64_t>(std::floor(value / cell)); };
    for (std::uint32_t i = 0; i < pieces_.size(); ++i) {
      DVec2 a = at(pieces_[i].a);
      DVec2 b = at(pieces_[i].b);
      if (a.x > b.x) std::swap(a, b);
      const double slope = b.x > a.x ? (b.y - a.y) / (b.x - a.x) : 0.0;
      for (std::int64_t x = row(a.x - tolerance_); x <= row(b.x + tolerance_); ++x) {
        // The part of the piece over this column, a tolerance wider.
        double low = a.y;
        double high = b.y;
        if (b.x > a.x) {
          low = a.y + slope * (std::clamp(double(x) * cell - tolerance_, a.x, b.x) - a.x);
          high = a.y + slope * (std::clamp(double(x + 1) * cell + tolerance_, a.x, b.x) - a.x);
        }
        if (low > high) std::swap(low, high);
        for (std::int64_t y = row(low - tolerance_); y <= row(high + tolerance_); ++y)
          entries_.push_back({static_cast<std::uint64_t>(x) << 32 ^ (static_cast<std::uint64_t>(y) & 0xffffffffu), i});
      }
    }
    std::sort(entries_.begin(), entries_.end());
  }

  /// Whether the second of two pieces gives way to the first.
  bool gives_way(std::uint32_t second, std::uint32_t first) const {
    const Layer a = pieces_[second].layer;
    const Layer b = pieces_[first].layer;
    return a != b ? b < a : first < second;
  }

  void find_covers() {
    for (std::size_t begin = 0; begin < entries_.size();) {
      std::size_t end = begin;
      while (end < entries_.size() && entries_[end].cell == entries_[begin].cell)
        ++end;
      for (std::size_t i = begin; i < end; ++i) {
        for (std::size_t k = i + 1; k < end; ++k) {
          const std::uint32_t one = entries_[i].piece;
          const std::uint32_t other = entries_[k].piece;
          if (gives_way(other, one)) {
            add_cover(other, one);
          } else {
            add_cover(one, other);
          }
        }
      }
      begin = end;
    }
    std::sort(covers_.begin(), covers_.end());
  }

  /// Notes which part of `under` lies on `over`.
  void add_cover(std::uint32_t under, std::uint32_t over) {
    const DVec2 along = along_[under];
    const double crossed = along.x * along_[over].y - along.y * along_[over].x;
    const double squares = glm::dot(along, along) * glm::dot(along_[over], along_[over]);
    // Most pairs: their tangent is above kParallel, with room for rounding.
    if (crossed * crossed > 1.01 * kParallel * kParallel * squares) return;
    const DVec2 start = at(pieces_[under].a);
    const double length = glm::length(along);
    const DVec2 direction = along / length;
    const DVec2 a = at(pieces_[over].a) - start;
    const DVec2 b = at(pieces_[over].b) - start;
    const double from_x = glm::dot(direction, a);
    const double to_x = glm::dot(direction, b);
    const double from_y = direction.x * a.y - direction.y * a.x;
    const double to_y = direction.x * b.y - direction.y * b.x;
    const double low = std::max(0.0, std::min(from_x, to_x));
    const double high = std::min(length, std::max(from_x, to_x));
    if (high - low <= tolerance_) return;
    const double slope = (to_y - from_y) / (to_x - from_x);
    const auto apart = [&](double x) { return std::abs(from_y + slope * (x - from_x)); };
    if (std::abs(slope) > kParallel || apart(low) > tolerance_ || apart(high) > tolerance_) return;
    covers_.push_back({under, low, high});
  }

  std::vector<Piece> cut() {
    std::vector<Piece> left;
    left.reserve(pieces_.size());
    auto cover = covers_.begin();
    for (std::uint32_t i = 0; i < pieces_.size(); ++i) {
      const auto first = cover;
      while (cover != covers_.end() && cover->piece == i)
        ++cover;
      if (first == cover) {
        left.push_back(pieces_[i]);
      } else {
        append_rest(pieces_[i], first, cover, left);
      }
    }
    return left;
  }

  /// What of a piece its covers leave. What is no longer than two tolerances is not worth a stroke.
  template <class Iterator>
  void append_rest(const Piece& piece, Iterator cover, Iterator end, std::vector<Piece>& left) {
    const DVec2 start = at(piece.a);
    const DVec2 along = at(piece.b) - start;
    const double length = glm::length(along);
    const auto node = [&](double x) {
      if (x <= 0.0) return piece.a;
      if (x >= length) return piece.b;
      const DVec2 point = start + along * (x / length);
      return nodes_.at(Steps(std::lround(point.x), std::lround(point.y)));
    };
    const auto append = [&](double from, double to) {
      if (to - from <= 2.0 * tolerance_) return;
      const NodeId a = node(from);
      const NodeId b = node(to);
      if (a != b) left.push_back({a, b, piece.line, piece.layer});
    };
    double free_from = 0.0;
    for (; cover != end; ++cover) {
      append(free_from, cover->from);
      free_from = std::max(free_from, cover->to);
    }
    append(free_from, length);
  }

  const std::vector<Piece>& pieces_;
  Nodes& nodes_;
  double tolerance_;
  std::vector<DVec2> along_;  ///< of each piece, from a to b
  std::vector<Entry> entries_;
  std::vector<Cover> covers_;
};

}  // namespace

std::vector<Piece> without_overlaps(const std::vector<Piece>& pieces, Nodes& nodes, double tolerance_steps) {
  return Overlaps(pieces, nodes, tolerance_steps).remove();
}

}  // namespace limn::drawing
