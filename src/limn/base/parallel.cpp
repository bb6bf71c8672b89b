#include "limn/base/parallel.h"

#include <cassert>

#ifdef LIMN_WITH_TBB
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#endif

namespace limn {

#ifdef LIMN_WITH_TBB

void parallel_for(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body) {
  assert(grain > 0);
  if (count <= grain) {
    if (count > 0) body(0, count);
    return;
  }
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain),
                    [&body](const tbb::blocked_range<std::size_t>& range) { body(range.begin(), range.end()); });
}

int thread_count() {
  return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

struct ThreadLimit::Impl {
  explicit Impl(int threads)
      : control(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads)) {}
  tbb::global_control control;
};

#else

void parallel_for(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body) {
  assert(grain > 0);
  static_cast<void>(grain);
  if (count > 0) body(0, count);
}

int thread_count() {
  return 1;
}

struct ThreadLimit::Impl {
  explicit Impl(int) {}
};

#endif

ThreadLimit::ThreadLimit(int threads) : impl_(std::make_unique<Impl>(threads)) {
  assert(threads >= 1);
}
ThreadLimit::~ThreadLimit() = default;

}  // namespace limn
