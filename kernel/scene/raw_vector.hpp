#pragma once
// Arrays that are written once by the threads that fill them: not cleared first, on large pages
// where the system has them.

#include <cstddef>
#include <cstdlib>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace grelha {

template <class T>
struct RawAllocator {
  static_assert(std::is_trivially_copyable_v<T>);
  using value_type = T;
  RawAllocator() = default;
  template <class U>
  RawAllocator(const RawAllocator<U>&) {}

  T* allocate(std::size_t n) {
    constexpr std::size_t kLine = 64;
    constexpr std::size_t kPage = std::size_t{1} << 21;
    if (n > (static_cast<std::size_t>(-1) >> 2) / sizeof(T))
      throw std::bad_alloc();
    const bool large = n * sizeof(T) >= 2 * kPage;
    const std::size_t align = large ? kPage : kLine;
    const std::size_t bytes = (n * sizeof(T) + kLine - 1) / kLine * kLine;
    void* const p = ::operator new (bytes, std::align_val_t{align});
#ifdef __linux__
    if (large)
      madvise(p, bytes, MADV_HUGEPAGE);  // a wish; refused, everything still works
#endif
    return static_cast<T*>(p);
  }
  void deallocate(T* p, std::size_t n) {
    ::operator delete (
        p, std::align_val_t{n * sizeof(T) >= std::size_t{1} << 22 ? std::size_t{1} << 21 : 64});
  }
  template <class U, class... Args>
  void construct(U* p, Args&&... args) {
    if constexpr (sizeof...(Args) > 0)
      ::new (static_cast<void*>(p)) U(std::forward<Args>(args)...);
  }
  bool operator==(const RawAllocator&) const {
    return true;
  }
};

/// resize() leaves what is new unset.
template <class T>
using RawVector = std::vector<T, RawAllocator<T>>;

/// Bytes of the elements of an array, whatever kind of array.
template <class V>
std::size_t bytes_of(const V& v) {
  return v.size() * sizeof v[0];
}

}  // namespace grelha
