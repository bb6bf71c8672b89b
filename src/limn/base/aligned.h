#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace limn {

/// Memory on cache lines; large blocks in large pages where the system has them, so that scattered reads of them do
/// not wait for the page table as well (a fifth of a search in a million triangles). Throws std::bad_alloc.
void* allocate_lines(std::size_t bytes);
void free_lines(void* memory, std::size_t bytes);

/// Allocates so for containers, and leaves numbers and plain structs as they are instead of clearing them.
template <class T>
struct LineAllocator {
  using value_type = T;  // NOLINT: the name that containers ask for

  LineAllocator() = default;
  template <class U>
  LineAllocator(const LineAllocator<U>&) {}  // NOLINT: allocators convert

  T* allocate(std::size_t count) { return static_cast<T*>(allocate_lines(count * sizeof(T))); }
  void deallocate(T* memory, std::size_t count) { free_lines(memory, count * sizeof(T)); }
  template <class U>
  void construct(U* at) {
    ::new (static_cast<void*>(at)) U;
  }
  template <class U, class... Args>
  void construct(U* at, Args&&... args) {
    ::new (static_cast<void*>(at)) U(static_cast<Args&&>(args)...);
  }
  template <class U>
  bool operator==(const LineAllocator<U>&) const {
    return true;
  }
};

/// A vector that starts on a cache line. resize() does not clear what it adds.
template <class T>
using LineVector = std::vector<T, LineAllocator<T>>;

}  // namespace limn
