#include "limn/hull/cost_queue.h"

#include <cassert>

namespace limn {

void CostQueue::push(const Candidate& candidate) {
  std::uint32_t id = free_;
  if (id == kInvalidId) {
    id = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back();
  } else {
    free_ = nodes_[id].next;
  }
  const std::uint32_t bucket = bucket_of(candidate.cost);
  nodes_[id] = {candidate, heads_[bucket]};
  heads_[bucket] = id;
  if (bucket < first_) first_ = bucket;
  ++size_;
}

Candidate CostQueue::pop() {
  assert(size_ > 0);
  const std::uint32_t bucket = lowest();
  const std::uint32_t id = heads_[bucket];
  heads_[bucket] = nodes_[id].next;
  nodes_[id].next = free_;
  free_ = id;
  --size_;
  return nodes_[id].candidate;
}

std::uint32_t CostQueue::lowest() {
  while (first_ < kBuckets && heads_[first_] == kInvalidId)
    ++first_;
  return first_;
}

}  // namespace limn
