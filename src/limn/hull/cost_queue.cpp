#include "limn/hull/cost_queue.h"

#include <algorithm>
#include <cassert>

namespace limn {

void CostQueue::clear() {
  for (std::vector<Candidate>& bucket : buckets_)
    bucket.clear();
  first_ = kBuckets;
  size_ = 0;
}

void CostQueue::push(const Candidate& candidate) {
  assert(candidate.cost >= 0.0f);
  // -0 would be the dearest.
  const std::uint32_t bucket = candidate.cost > 0.0f ? bucket_of(candidate.cost) : 0;
  buckets_[bucket].push_back(candidate);
  first_ = std::min(first_, bucket);
  ++size_;
}

Candidate CostQueue::pop() {
  assert(size_ > 0);
  std::vector<Candidate>& bucket = buckets_[lowest()];
  const Candidate candidate = bucket.back();
  bucket.pop_back();
  --size_;
  return candidate;
}

std::uint32_t CostQueue::lowest() {
  while (first_ < kBuckets && buckets_[first_].empty())
    ++first_;
  return first_;
}

}  // namespace limn
