#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace limn {

/// Calls body(begin, end) over disjoint ranges that together cover [0, count), possibly at once on several threads.
///
/// \param grain  the smallest range worth a task of its own; ranges may be larger
/// \pre  grain > 0; body is safe to call concurrently on disjoint ranges and throws nothing
/// How the ranges are cut may differ from run to run: a body whose output for an index depends on that index alone
/// gives the same bits for any number of threads. Runs on the calling thread when built without TBB.
void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t begin, std::size_t end)>& body);

/// How many threads parallel_for may use now.
int thread_count();

/// Limits parallel_for, for the whole process, to `threads` threads while it lives.
/// For programs, not for libraries. \pre threads >= 1
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace limn
