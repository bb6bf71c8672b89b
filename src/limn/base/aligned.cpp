#include "limn/base/aligned.h"

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace limn {
namespace {

constexpr std::size_t kLine = 64;
constexpr std::size_t kLargePage = std::size_t{2} << 20;

/// Smaller blocks lie in few pages anyway.
constexpr std::size_t kWorthLargePages = 2 * kLargePage;

std::align_val_t alignment_of(std::size_t bytes) {
  return std::align_val_t{bytes >= kWorthLargePages ? kLargePage : kLine};
}

}  // namespace

void* allocate_lines(std::size_t bytes) {
  void* memory = ::operator new(bytes, alignment_of(bytes));
#if defined(__linux__)
  // A wish: what comes of it changes no result.
  if (bytes >= kWorthLargePages) madvise(memory, bytes / kLargePage * kLargePage, MADV_HUGEPAGE);
#endif
  return memory;
}

void free_lines(void* memory, std::size_t bytes) {
  ::operator delete(memory, alignment_of(bytes));
}

}  // namespace limn
