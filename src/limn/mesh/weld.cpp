#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>

#include "limn/mesh/topology.h"

namespace limn {
namespace {

std::uint64_t mix(std::uint64_t x) {
  x ^= x >> 32;
  x *= 0xd6e8feb86659fd93ull;
  x ^= x >> 32;
  return x;
}

/// Equal positions have equal keys, and no others do: adding 0 turns -0 into 0.
std::array<std::uint32_t, 3> key_of(const Vec3& p) {
  return {std::bit_cast<std::uint32_t>(p.x + 0.0f), std::bit_cast<std::uint32_t>(p.y + 0.0f),
          std::bit_cast<std::uint32_t>(p.z + 0.0f)};
}

std::uint64_t hash_position(const Vec3& p) {
  const auto [x, y, z] = key_of(p);
  return mix((x | (std::uint64_t{y} << 32)) * 0x9e3779b97f4a7c15ull ^ mix(z));
}

/// Slower than the table, but no choice of positions makes it slower still.
std::vector<VertexId> weld_by_sorting(std::span<const Vec3> positions) {
  std::vector<VertexId> order(positions.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [positions](VertexId a, VertexId b) {
    const auto key_a = key_of(positions[a]);
    const auto key_b = key_of(positions[b]);
    return key_a != key_b ? key_a < key_b : a < b;
  });
  std::vector<VertexId> weld(positions.size());
  VertexId lowest = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i == 0 || positions[order[i]] != positions[order[i - 1]]) lowest = order[i];
    weld[order[i]] = lowest;
  }
  return weld;
}

/// One pass over a hash table; by sorting where the positions crowd its slots, as only a file made to do so has them.
std::vector<VertexId> weld_exactly(std::span<const Vec3> positions) {
  constexpr std::size_t kProbesPerPosition = 16;
  std::size_t probes_left = kProbesPerPosition * positions.size();
  std::vector<VertexId> weld(positions.size());
  const std::size_t slots = std::bit_ceil(std::max<std::size_t>(16, positions.size() * 2));
  std::vector<VertexId> table(slots, kInvalidId);
  // The table outgrows the caches: ask for a block's slots before any of them is read.
  constexpr std::size_t kBlock = 32;
  std::array<std::size_t, kBlock> start{};
  for (std::size_t begin = 0; begin < positions.size(); begin += kBlock) {
    const std::size_t count = std::min(kBlock, positions.size() - begin);
    for (std::size_t i = 0; i < count; ++i) {
      start[i] = hash_position(positions[begin + i]) & (slots - 1);
      __builtin_prefetch(&table[start[i]], 1);
    }
    for (std::size_t i = 0; i < count; ++i) {
      const VertexId vertex = static_cast<VertexId>(begin + i);
      std::size_t slot = start[i];
      while (table[slot] != kInvalidId && positions[table[slot]] != positions[vertex]) {
        if (probes_left-- == 0) return weld_by_sorting(positions);
        slot = (slot + 1) & (slots - 1);
      }
      if (table[slot] == kInvalidId) table[slot] = vertex;
      weld[vertex] = table[slot];
    }
  }
  return weld;
}

/// A forest whose roots are the lowest members of their sets.
class LowestUnion {
 public:
  explicit LowestUnion(std::size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), 0u); }
  VertexId root(VertexId v) {
    while (parent_[v] != v)
      v = parent_[v] = parent_[parent_[v]];
    return v;
  }
  void join(VertexId a, VertexId b) {
    a = root(a);
    b = root(b);
    if (a < b) parent_[b] = a;
    if (b < a) parent_[a] = b;
  }

 private:
  std::vector<VertexId> parent_;
};

/// Points in a grid of cells as wide as the tolerance: near ones lie in the same or in neighbouring cells.
/// Cells are kept as whole-numbered doubles, which no coordinate overflows.
std::vector<VertexId> weld_nearly(std::span<const Vec3> positions, float tolerance) {
  const double width = tolerance;
  const auto cell_of = [width](const Vec3& p) {
    return std::array<double, 3>{std::floor(p.x / width), std::floor(p.y / width), std::floor(p.z / width)};
  };
  const auto hash_cell = [](const std::array<double, 3>& cell) {
    std::uint64_t hash = 0;
    for (const double c : cell)
      hash = mix(hash * 0x9e3779b97f4a7c15ull ^ std::bit_cast<std::uint64_t>(c + 0.0));
    return hash;
  };
  const std::size_t slots = std::bit_ceil(std::max<std::size_t>(16, positions.size()));
  std::vector<VertexId> first(slots, kInvalidId);
  std::vector<VertexId> next(positions.size(), kInvalidId);
  LowestUnion sets(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const auto vertex = static_cast<VertexId>(i);
    const std::array<double, 3> cell = cell_of(positions[i]);
    for (int n = 0; n < 27; ++n) {
      const std::array<int, 3> step{n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
      const std::array<double, 3> near{cell[0] + step[0], cell[1] + step[1], cell[2] + step[2]};
      for (VertexId other = first[hash_cell(near) & (slots - 1)]; other != kInvalidId; other = next[other]) {
        const DVec3 d = DVec3(positions[i]) - DVec3(positions[other]);
        if (d.x * d.x + d.y * d.y + d.z * d.z <= width * width) sets.join(vertex, other);
      }
    }
    VertexId& head = first[hash_cell(cell) & (slots - 1)];
    next[i] = head;
    head = vertex;
  }
  std::vector<VertexId> weld(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i)
    weld[i] = sets.root(static_cast<VertexId>(i));
  return weld;
}

}  // namespace

std::vector<VertexId> weld_positions(std::span<const Vec3> positions, const WeldOptions& options) {
  return options.tolerance > 0.0f ? weld_nearly(positions, options.tolerance) : weld_exactly(positions);
}

}  // namespace limn
