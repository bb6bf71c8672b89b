#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "limn/base/vec.h"
#include "limn/mesh/ids.h"

namespace limn {

/// An edge that could collapse, where to, and when that was found.
struct Candidate {
  VertexId a, b;
  std::uint32_t born;     ///< sum of both vertices' births
  std::uint32_t touched;  ///< sum of both vertices' touches
  Vec3 position;
  float cost;
};

/// Candidates by cost, to 1 part in 128: buckets by the leading bits of the cost, in a bucket last in, first out.
/// Pushing and popping take constant time and read memory in order, where a heap's comparisons miss the cache.
class CostQueue {
 public:
  CostQueue() : buckets_(kBuckets) {}

  bool empty() const { return size_ == 0; }
  void clear();
  /// \pre cost >= 0
  void push(const Candidate& candidate);
  /// \pre !empty()
  Candidate pop();
  /// Whether a candidate of this cost would be among the next.
  bool is_next(float cost) { return bucket_of(cost) <= lowest(); }

 private:
  static constexpr std::uint32_t kBuckets = 1u << 15;
  static std::uint32_t bucket_of(float cost) { return std::bit_cast<std::uint32_t>(cost) >> 16; }
  std::uint32_t lowest();

  std::vector<std::vector<Candidate>> buckets_;
  std::uint32_t first_ = kBuckets;
  std::size_t size_ = 0;
};

}  // namespace limn
