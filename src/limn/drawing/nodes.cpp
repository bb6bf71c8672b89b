#include "limn/drawing/nodes.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "limn/mesh/ids.h"

namespace limn::drawing {
namespace {

/// Rounds towards minus infinity.
std::int32_t floor_division(std::int32_t a, std::int32_t b) {
  return a >= 0 ? a / b : -((b - 1 - a) / b);
}

std::uint64_t hash(const Steps& cell) {
  const std::uint64_t key = std::uint64_t{std::bit_cast<std::uint32_t>(cell.x)} << 32 |  //
                            std::uint64_t{std::bit_cast<std::uint32_t>(cell.y)};
  const std::uint64_t mixed = (key ^ key >> 29) * 0xbf58476d1ce4e5b9u;
  return mixed ^ mixed >> 32;
}

}  // namespace

Nodes::Nodes(double tolerance_steps, std::size_t expected)
    : limit_(tolerance_steps * tolerance_steps),
      cell_size_(std::max(1, static_cast<std::int32_t>(std::ceil(tolerance_steps)))),
      table_(std::bit_ceil(std::max<std::size_t>(16, 2 * expected)), Slot{{}, kInvalidId}) {
  points_.reserve(expected);
  next_.reserve(expected);
}

std::size_t Nodes::slot_of(const Steps& cell) const {
  const std::size_t mask = table_.size() - 1;
  std::size_t slot = hash(cell) & mask;
  while (table_[slot].head != kInvalidId && table_[slot].cell != cell)
    slot = (slot + 1) & mask;
  return slot;
}

void Nodes::grow() {
  std::vector<Slot> old(2 * table_.size(), Slot{{}, kInvalidId});
  old.swap(table_);
  for (const Slot& slot : old) {
    if (slot.head != kInvalidId) table_[slot_of(slot.cell)] = slot;
  }
}

NodeId Nodes::at(const Steps& point) {
  const Steps cell(floor_division(point.x, cell_size_), floor_division(point.y, cell_size_));
  NodeId best = kInvalidId;
  double best_distance = limit_;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      for (NodeId node = table_[slot_of(cell + Steps(dx, dy))].head; node != kInvalidId; node = next_[node]) {
        const double x = double(points_[node].x) - double(point.x);
        const double y = double(points_[node].y) - double(point.y);
        const double distance = x * x + y * y;
        if (distance < best_distance || (distance == best_distance && node < best)) {
          best = node;
          best_distance = distance;
        }
      }
    }
  }
  if (best != kInvalidId) return best;
  if (2 * (used_ + 1) > table_.size()) grow();
  Slot& slot = table_[slot_of(cell)];
  if (slot.head == kInvalidId) ++used_;
  const auto node = static_cast<NodeId>(points_.size());
  next_.push_back(slot.head);
  slot = {cell, node};
  points_.push_back(point);
  return node;
}

}  // namespace limn::drawing
