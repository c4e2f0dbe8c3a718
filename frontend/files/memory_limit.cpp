#include "frontend/files/memory_limit.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <cstdio>
#include <limits>
#include <memory>

#if defined(__has_feature)  // clang
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define GRELHA_SANITIZED
#endif
#elif defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define GRELHA_SANITIZED
#endif

namespace grelha {

#ifdef GRELHA_SANITIZED
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

bool memory_can_be_limited() {
  return !kSanitized;
}

std::uint64_t system_memory() {
  const long pages = sysconf(_SC_PHYS_PAGES), page_size = sysconf(_SC_PAGE_SIZE);
  return pages > 0 && page_size > 0 ? std::uint64_t(pages) * std::uint64_t(page_size) : 0;
}

namespace {

/// Bytes that count against RLIMIT_DATA; 0 where the system does not say.
std::uint64_t memory_owned() {
  unsigned long long pages[6] = {};  // size, resident, shared, text, libraries, data
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen("/proc/self/statm", "r"),
                                                             std::fclose);
  if (!file)
    return 0;
  for (unsigned long long& n : pages)
    if (std::fscanf(file.get(), "%llu", &n) != 1)
      return 0;
  return pages[5] * std::uint64_t(sysconf(_SC_PAGE_SIZE));
}

bool requested = false;  ///< the limit comes from --max-memory; global, as the limit is

}  // namespace

OwnMemory own_memory() {
  rlimit limit{};
  const bool limited = memory_can_be_limited() && getrlimit(RLIMIT_DATA, &limit) == 0 &&
                       limit.rlim_cur != RLIM_INFINITY;
  return {limited ? std::uint64_t(limit.rlim_cur) : std::numeric_limits<std::uint64_t>::max(),
          memory_owned()};
}

// RLIMIT_DATA counts what a process can write and does not share, and, unlike RLIMIT_AS, not what
// malloc only reserves.
void limit_memory(std::uint64_t bytes) {
  rlimit limit{};
  requested = bytes > 0;
  if (!requested)
    bytes = system_memory();
  if (!memory_can_be_limited() || bytes == 0 || getrlimit(RLIMIT_DATA, &limit) != 0)
    return;
  if (limit.rlim_max == RLIM_INFINITY || bytes < limit.rlim_max)
    limit.rlim_cur = bytes;
  setrlimit(RLIMIT_DATA, &limit);
}

std::string gigabytes(std::uint64_t bytes) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g GB", double(bytes) / 1e9);
  return text;
}

std::string available_memory() {
  rlimit limit{};
  const std::uint64_t least = own_memory().limit;
  if (least == std::numeric_limits<std::uint64_t>::max() || getrlimit(RLIMIT_DATA, &limit) != 0)
    return gigabytes(system_memory()) + ", all that this machine has";
  if (least == limit.rlim_max)
    return gigabytes(least) + " (ulimit -d)";
  if (requested)
    return gigabytes(least) + " (--max-memory)";
  return gigabytes(least) + ", all that this machine has (--max-memory sets another bound)";
}

std::string out_of_memory() {
  return "out of memory: needed more than " + available_memory();
}

}  // namespace grelha
