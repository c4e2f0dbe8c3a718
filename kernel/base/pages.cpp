#include "kernel/base/pages.hpp"

#include <algorithm>
#include <cstdint>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace grelha {
namespace {

/// The least that is asked for: below, the call takes as long as what it saves.
constexpr std::size_t kLeast = std::size_t{1} << 16;

#ifdef __linux__
constexpr std::size_t kPage = 4096;  // where they are larger, most of this is refused
constexpr int kLarge = MADV_HUGEPAGE;
constexpr int kPopulateWrite =
    23;  ///< MADV_POPULATE_WRITE, which older systems and headers do not know
#else
constexpr std::size_t kPage = kLargePage;
constexpr int kLarge = 0, kPopulateWrite = 0;

void madvise(void*, std::size_t, int) {}
int mincore(void*, std::size_t, unsigned char*) {
  return -1;
}
#endif

/// Pages that lie wholly within a piece of memory: the others may hold other data.
struct Pages {
  std::uintptr_t begin, end;

  void advise(int what) const {
    if (begin < end)
      madvise(reinterpret_cast<void*>(begin), end - begin, what);
  }
  /// Memory that was used before mostly still has its pages: asking for these would take long.
  void take() const {
    if (begin < end && !(has(begin) && has(end - kPage)))
      advise(kPopulateWrite);
  }

 private:
  static bool has(std::uintptr_t page) {
    unsigned char there = 0;
    return mincore(reinterpret_cast<void*>(page), kPage, &there) == 0 && (there & 1) != 0;
  }
};

Pages pages_of(std::size_t size, const void* memory, std::size_t bytes) {
  const auto address = reinterpret_cast<std::uintptr_t>(memory);
  const std::uintptr_t begin = (address + size - 1) / size * size;
  return {begin, std::max(begin, (address + bytes) / size * size)};
}

}  // namespace

void advise_huge_pages(void* memory, std::size_t bytes) {
  pages_of(kLargePage, memory, bytes).advise(kLarge);
}

void populate_pages(void* memory, std::size_t bytes) {
  if (bytes < kLeast)
    return;
  const Pages all = pages_of(kPage, memory, bytes), large = pages_of(kLargePage, memory, bytes);
  large.advise(kLarge);  // each thread that writes there takes its own
  Pages{all.begin, std::min(large.begin, all.end)}.take();
  Pages{large.end, all.end}.take();
}

}  // namespace grelha
