// Contains errors that a sanitizer must report and, without an argument, code that the thread
// sanitizer must not report: OpenMP used as in the kernel. It is only built with sanitizers
// (tests/sanitizers.cmake).
#include <cstdio>
#include <limits>
#include <numeric>
#include <string_view>
#include <vector>

namespace {

constexpr int kCount = 100000;

/// Threads that write apart, then read what others wrote, sum up, and take turns.
long in_order() {
  std::vector<int> values(kCount);
  long sum = 0, turns = 0;
#pragma omp parallel num_threads(4)
  {
#pragma omp for schedule(static)
    for (int i = 0; i < kCount; ++i)
      values[static_cast<std::size_t>(i)] = i;
#pragma omp for schedule(dynamic, 64) reduction(+ : sum)
    for (int i = 0; i < kCount; ++i)
      sum += values[static_cast<std::size_t>(kCount - 1 - i)];
#pragma omp critical
    turns += 1;
  }
  std::iota(values.begin(), values.end(), 1);
  return sum + turns + values[0];
}

long race() {
  long sum = 0;
#pragma omp parallel for schedule(static) num_threads(4)
  for (int i = 0; i < kCount; ++i)
    sum += i;
  return sum;
}

long past_the_end() {
  // volatile, here and below: the compiler shall not see what comes
  const volatile std::size_t size = 100;
  const std::vector<char> bytes(size);
  return bytes.data()[size];
}

long leak() {
  char* volatile lost = new char[100];
  lost[0] = 1;
  lost = nullptr;
  return 0;
}

long overflow() {
  const volatile int most = std::numeric_limits<int>::max();
  return most + 1;
}

long cast() {
  const volatile float large = 1e30f;
  return static_cast<int>(large);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string_view fault = argc > 1 ? argv[1] : "";
  const long result = fault == "race"     ? race()
                      : fault == "past"   ? past_the_end()
                      : fault == "leak"   ? leak()
                      : fault == "signed" ? overflow()
                      : fault == "cast"   ? cast()
                                          : in_order();
  std::printf("%ld\n", result);
}
