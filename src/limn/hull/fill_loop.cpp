#include "limn/hull/fill_loop.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <queue>

namespace limn {
namespace {

constexpr std::size_t kSmallLoop = 40;
constexpr double kNever = std::numeric_limits<double>::infinity();

using Pair = std::pair<std::uint32_t, std::uint32_t>;

bool is_forbidden(std::span<const Pair> forbidden, std::uint32_t a, std::uint32_t b) {
  return std::binary_search(forbidden.begin(), forbidden.end(), Pair(std::min(a, b), std::max(a, b)));
}

double squared(const DVec3& v) {
  return glm::dot(v, v);
}

/// Area first; a hundredth of the squared sides, so that of the many fillings of a flat loop a round one is taken.
double triangle_cost(std::span<const Vec3> corners, std::size_t a, std::size_t b, std::size_t c) {
  const DVec3 pa(corners[a]), pb(corners[b]), pc(corners[c]);
  return 0.5 * glm::length(glm::cross(pb - pa, pc - pa)) +
         0.01 * (squared(pb - pa) + squared(pc - pb) + squared(pa - pc));
}

void add_fan(std::span<const Vec3> corners, std::span<const std::uint32_t> ring, LoopFilling& filling) {
  DVec3 sum(0.0);
  for (const std::uint32_t i : ring)
    sum += DVec3(corners[i]);
  filling.has_middle = true;
  filling.middle = Vec3(sum / static_cast<double>(ring.size()));
  const auto middle = static_cast<std::uint32_t>(corners.size());
  for (std::size_t i = 0; i < ring.size(); ++i)
    filling.triangles.push_back({ring[i], ring[(i + 1) % ring.size()], middle});
}

/// best[i][j] is the least cost of filling corners i … j.
class LeastCost {
 public:
  LeastCost(std::span<const Vec3> corners, std::span<const Pair> forbidden)
      : count_(corners.size()), cost_(count_ * count_, kNever), split_(count_ * count_, 0) {
    for (std::size_t i = 0; i + 1 < count_; ++i)
      cost_[i * count_ + i + 1] = 0;
    for (std::size_t length = 2; length < count_; ++length) {
      for (std::size_t i = 0; i + length < count_; ++i)
        solve(corners, forbidden, i, i + length);
    }
  }

  bool found() const { return cost_[count_ - 1] < kNever; }

  void list(std::vector<std::array<std::uint32_t, 3>>& triangles) const {
    std::vector<Pair> open{{0u, static_cast<std::uint32_t>(count_ - 1)}};
    while (!open.empty()) {
      const auto [i, j] = open.back();
      open.pop_back();
      if (j - i < 2) continue;
      const std::uint32_t k = split_[i * count_ + j];
      triangles.push_back({i, k, j});
      open.emplace_back(i, k);
      open.emplace_back(k, j);
    }
  }

 private:
  void solve(std::span<const Vec3> corners, std::span<const Pair> forbidden, std::size_t i, std::size_t j) {
    const bool whole = i == 0 && j + 1 == count_;
    if (!whole && is_forbidden(forbidden, static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j))) return;
    for (std::size_t k = i + 1; k < j; ++k) {
      const double parts = cost_[i * count_ + k] + cost_[k * count_ + j];
      if (parts == kNever) continue;
      const double cost = parts + triangle_cost(corners, i, k, j);
      if (cost >= cost_[i * count_ + j]) continue;
      cost_[i * count_ + j] = cost;
      split_[i * count_ + j] = static_cast<std::uint32_t>(k);
    }
  }

  std::size_t count_;
  std::vector<double> cost_;
  std::vector<std::uint32_t> split_;
};

/// Cuts corners off a large loop.
class CornerCutter {
 public:
  CornerCutter(std::span<const Vec3> corners, std::span<const Pair> forbidden)
      : corners_(corners), forbidden_(forbidden), left_(corners.size()), next_(left_), previous_(left_), stamp_(left_) {
    // The loop's area as a vector, about its first corner, tells which corners turn against it.
    for (std::size_t i = 1; i + 1 < left_; ++i) {
      area_ += glm::cross(DVec3(corners[i]) - DVec3(corners[0]), DVec3(corners[i + 1]) - DVec3(corners[0]));
    }
    const auto count = static_cast<std::uint32_t>(left_);
    for (std::uint32_t i = 0; i < count; ++i) {
      next_[i] = (i + 1) % count;
      previous_[i] = (i + count - 1) % count;
    }
    for (std::uint32_t i = 0; i < count; ++i)
      offer(i);
  }

  void cut(LoopFilling& filling) {
    std::uint32_t last = 0;
    while (left_ > 3 && !heap_.empty()) {
      const Offer best = heap_.top();
      heap_.pop();
      if (best.stamp != stamp_[best.corner]) continue;
      const std::uint32_t a = previous_[best.corner], b = next_[best.corner];
      filling.triangles.push_back({a, best.corner, b});
      stamp_[best.corner] = kGone;
      next_[a] = b;
      previous_[b] = a;
      --left_;
      offer(a);
      offer(b);
      last = a;
    }
    std::vector<std::uint32_t> ring;
    for (std::uint32_t i = last, n = 0; n < left_; i = next_[i], ++n)
      ring.push_back(i);
    if (left_ == 3) {
      filling.triangles.push_back({ring[0], ring[1], ring[2]});
    } else {
      add_fan(corners_, ring, filling);
    }
  }

 private:
  static constexpr std::uint32_t kGone = 0xffffffffu;
  struct Offer {
    bool turned;
    double length;
    std::uint32_t corner, stamp;
    /// The queue gives the greatest first.
    bool operator<(const Offer& other) const {
      if (turned != other.turned) return turned;
      if (length != other.length) return length > other.length;
      return corner > other.corner;
    }
  };

  /// Puts the corner up for cutting as it is now; offers made before no longer count.
  void offer(std::uint32_t i) {
    ++stamp_[i];
    const std::uint32_t a = previous_[i], b = next_[i];
    if (is_forbidden(forbidden_, a, b)) return;
    const DVec3 pa(corners_[a]), pi(corners_[i]), pb(corners_[b]);
    const bool turned = glm::dot(glm::cross(pi - pa, pb - pa), area_) <= 0;
    heap_.push({turned, squared(pb - pa), i, stamp_[i]});
  }

  std::span<const Vec3> corners_;
  std::span<const Pair> forbidden_;
  std::size_t left_;
  std::vector<std::uint32_t> next_, previous_, stamp_;
  DVec3 area_{0.0};
  std::priority_queue<Offer> heap_;
};

}  // namespace

LoopFilling fill_loop(std::span<const Vec3> corners, std::span<const Pair> forbidden) {
  assert(corners.size() >= 3);
  LoopFilling filling;
  if (corners.size() > kSmallLoop) {
    CornerCutter(corners, forbidden).cut(filling);
    return filling;
  }
  const LeastCost least(corners, forbidden);
  if (least.found()) {
    least.list(filling.triangles);
    return filling;
  }
  std::vector<std::uint32_t> ring(corners.size());
  for (std::uint32_t i = 0; i < ring.size(); ++i)
    ring[i] = i;
  add_fan(corners, ring, filling);
  return filling;
}

}  // namespace limn
