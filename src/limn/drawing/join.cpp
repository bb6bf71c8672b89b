#include "limn/drawing/join.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "limn/mesh/ids.h"

namespace limn::drawing {
namespace {

using DVec2 = glm::dvec2;

/// An end of a piece: 2 · piece for its a, 2 · piece + 1 for its b.
using EndId = std::uint32_t;

class Joiner {
 public:
  explicit Joiner(const std::vector<Piece>& pieces)
      : pieces_(pieces), partner_(2 * pieces.size(), kInvalidId), taken_(pieces.size(), false) {}

  std::vector<Chain> join() {
    pair_along_lines();
    pair_what_is_left();
    // Chains with ends first, from their beginnings where they have one; what remains is closed.
    for (const EndId side : {0u, 1u}) {
      for (EndId end = side; end < partner_.size(); end += 2) {
        if (!taken_[end / 2] && partner_[end] == kInvalidId) walk(end);
      }
    }
    for (EndId end = 0; end < partner_.size(); end += 2) {
      if (!taken_[end / 2]) walk(end);
    }
    order();
    return std::move(chains_);
  }

 private:
  NodeId node_of(EndId end) const { return end % 2 == 0 ? pieces_[end / 2].a : pieces_[end / 2].b; }

  void pair(EndId one, EndId other) {
    partner_[one] = other;
    partner_[other] = one;
  }

  /// The end of a line counts as before its beginning.
  void pair_along_lines() {
    for (std::uint32_t begin = 0, end = 0; begin < pieces_.size(); begin = end) {
      for (end = begin + 1; end < pieces_.size() && pieces_[end].line == pieces_[begin].line; ++end) {
        if (pieces_[end - 1].b == pieces_[end].a) pair(2 * end - 1, 2 * end);
      }
      if (end > begin + 1 && pieces_[end - 1].b == pieces_[begin].a) pair(2 * end - 1, 2 * begin);
    }
  }

  void pair_what_is_left() {
    std::vector<EndId> ends;
    for (EndId end = 0; end < partner_.size(); ++end) {
      if (partner_[end] == kInvalidId) ends.push_back(end);
    }
    const auto place = [this](EndId end) { return std::pair(pieces_[end / 2].layer, node_of(end)); };
    std::stable_sort(ends.begin(), ends.end(), [&](EndId a, EndId b) { return place(a) < place(b); });
    for (std::size_t begin = 0; begin < ends.size();) {
      std::size_t end = begin + 1;
      while (end < ends.size() && place(ends[end]) == place(ends[begin]))
        ++end;
      if (end - begin == 2) pair(ends[begin], ends[begin + 1]);
      begin = end;
    }
  }

  /// Follows the chain that leaves through the other end of this piece.
  void walk(EndId start) {
    Chain chain;
    chain.layer = pieces_[start / 2].layer;
    chain.nodes.push_back(node_of(start));
    order_.push_back(start / 2);
    EndId at = start;
    while (at != kInvalidId && !taken_[at / 2]) {
      taken_[at / 2] = true;
      order_.back() = std::min(order_.back(), at / 2);
      chain.nodes.push_back(node_of(at ^ 1u));
      at = partner_[at ^ 1u];
    }
    chain.closed = at == start;
    if (chain.closed) chain.nodes.pop_back();
    chains_.push_back(std::move(chain));
  }

  void order() {
    std::vector<std::uint32_t> by(chains_.size());
    for (std::uint32_t i = 0; i < by.size(); ++i)
      by[i] = i;
    std::sort(by.begin(), by.end(), [this](std::uint32_t a, std::uint32_t b) {
      return std::pair(chains_[a].layer, order_[a]) < std::pair(chains_[b].layer, order_[b]);
    });
    std::vector<Chain> sorted;
    sorted.reserve(by.size());
    for (const std::uint32_t i : by)
      sorted.push_back(std::move(chains_[i]));
    chains_.swap(sorted);
  }

  const std::vector<Piece>& pieces_;
  std::vector<EndId> partner_;
  std::vector<bool> taken_;
  std::vector<Chain> chains_;
  std::vector<std::uint32_t> order_;  ///< the lowest piece of each chain
};

/// The directions from an anchor that pass within a tolerance of every point seen so far.
class Sleeve {
 public:
  Sleeve(const DVec2& anchor, double tolerance) : anchor_(anchor), tolerance_(tolerance) {}

  /// Whether a straight line to the point is within the tolerance of all points before it.
  bool reaches(const DVec2& point) const {
    const DVec2 d = point - anchor_;
    const double distance = glm::length(d);
    if (distance < farthest_) return false;
    return !bounded_ || (cross(right_, d) >= 0.0 && cross(d, left_) >= 0.0);
  }

  /// Takes a point into account. \pre reaches(point)
  void narrow(const DVec2& point) {
    const DVec2 d = point - anchor_;
    const double distance = glm::length(d);
    farthest_ = distance;
    if (distance <= tolerance_) return;
    // The tangents from the anchor to the circle around the point.
    const double sine = tolerance_ / distance;
    const double cosine = std::sqrt(1.0 - sine * sine);
    const DVec2 right(d.x * cosine + d.y * sine, d.y * cosine - d.x * sine);
    const DVec2 left(d.x * cosine - d.y * sine, d.y * cosine + d.x * sine);
    if (!bounded_ || cross(right_, right) > 0.0) right_ = right;
    if (!bounded_ || cross(left, left_) > 0.0) left_ = left;
    bounded_ = true;
  }

 private:
  static double cross(const DVec2& a, const DVec2& b) { return a.x * b.y - a.y * b.x; }

  DVec2 anchor_;
  double tolerance_;
  double farthest_ = 0.0;
  bool bounded_ = false;
  DVec2 right_{};
  DVec2 left_{};
};

/// Lets a closed chain begin at the node farthest from its first, which is a true corner.
void begin_at_corner(std::vector<NodeId>& chain, const Nodes& nodes) {
  const DVec2 first(nodes[chain.front()]);
  std::size_t corner = 0;
  double farthest = -1.0;
  for (std::size_t i = 0; i < chain.size(); ++i) {
    const double distance = glm::distance(DVec2(nodes[chain[i]]), first);
    if (distance > farthest) {
      farthest = distance;
      corner = i;
    }
  }
  std::rotate(chain.begin(), chain.begin() + static_cast<std::ptrdiff_t>(corner), chain.end());
}

}  // namespace

std::vector<Chain> join(const std::vector<Piece>& pieces) {
  return Joiner(pieces).join();
}

void straighten(Chain& chain, const Nodes& nodes, double tolerance_steps) {
  if (chain.closed) {
    begin_at_corner(chain.nodes, nodes);
    chain.nodes.push_back(chain.nodes.front());
  }
  std::vector<NodeId> kept{chain.nodes.front()};
  for (std::size_t at = 0; at + 1 < chain.nodes.size();) {
    Sleeve sleeve{DVec2(nodes[chain.nodes[at]]), tolerance_steps};
    std::size_t next = at + 1;
    sleeve.narrow(DVec2(nodes[chain.nodes[next]]));
    while (next + 1 < chain.nodes.size() && sleeve.reaches(DVec2(nodes[chain.nodes[next + 1]]))) {
      ++next;
      sleeve.narrow(DVec2(nodes[chain.nodes[next]]));
    }
    kept.push_back(chain.nodes[next]);
    at = next;
  }
  if (chain.closed) {
    kept.pop_back();
    chain.closed = kept.size() > 2;
  }
  chain.nodes.swap(kept);
}

}  // namespace limn::drawing
