#pragma once
// Arrays that are written once by the threads that fill them: not cleared first, on large pages
// where the system has them.

#include <cstddef>
#include <cstdlib>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

#include "kernel/base/pages.hpp"

namespace grelha {

template <class T>
struct RawAllocator {
  static_assert(std::is_trivially_copyable_v<T>);
  using value_type = T;
  RawAllocator() = default;
  template <class U>
  RawAllocator(const RawAllocator<U>&) {}

  T* allocate(std::size_t n) {
    if (n > (static_cast<std::size_t>(-1) >> 2) / sizeof(T))
      throw std::bad_alloc();
    const std::size_t align = alignment(n);
    const std::size_t bytes = bytes_for(n);
    void* const p = ::operator new (bytes, std::align_val_t{align});
    populate_pages(p, bytes);
    return static_cast<T*>(p);
  }
  void deallocate(T* p, std::size_t n) { ::operator delete (p, std::align_val_t{alignment(n)}); }
  template <class U, class... Args>
  void construct(U* p, Args&&... args) {
    if constexpr (sizeof...(Args) > 0)
      ::new (static_cast<void*>(p)) U(std::forward<Args>(args)...);
  }
  bool operator==(const RawAllocator&) const { return true; }

  /// Bytes that n elements take.
  static std::size_t bytes_for(std::size_t n) {
    const std::size_t in_pages = up_to(alignment(n), n * sizeof(T));
    const bool few =
        static_cast<double>(in_pages) <= kMaxReserve * static_cast<double>(n * sizeof(T));
    return few ? in_pages : up_to(kLine, n * sizeof(T));
  }

 private:
  static constexpr std::size_t kLine = 64;
  /// At most kMaxReserve * bytes asked for are taken so that the last page is a large one too.
  static constexpr double kMaxReserve = 1.125;

  static std::size_t alignment(std::size_t n) {
    return n * sizeof(T) >= kLargePage ? kLargePage : kLine;
  }
  static std::size_t up_to(std::size_t unit, std::size_t bytes) {
    return (bytes + unit - 1) / unit * unit;
  }
};

/// resize() leaves new elements uninitialized.
template <class T>
using RawVector = std::vector<T, RawAllocator<T>>;

/// Bytes of the elements of an array, whatever kind of array.
template <class V>
std::size_t bytes_of(const V& v) {
  return v.size() * sizeof v[0];
}

}  // namespace grelha
