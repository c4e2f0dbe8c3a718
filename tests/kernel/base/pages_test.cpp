// Pages that are asked for before they are written, and arrays that do so.
#include "kernel/base/pages.hpp"

#include <cstdint>
#include <numeric>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include "kernel/base/raw_vector.hpp"

namespace grelha::test {
namespace {

constexpr std::size_t kPage = 4096;

long faults_so_far() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  return used.ru_minflt;
}

/// Memory whose pages were never touched.
class NewMemory {
 public:
  explicit NewMemory(std::size_t bytes)
      : bytes_(bytes),
        data_(mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0)) {}
  NewMemory(const NewMemory&) = delete;
  ~NewMemory() { munmap(data_, bytes_); }

  char* data() const { return static_cast<char*>(data_); }
  /// How often writing to each page interrupts.
  long faults_of_writing() const {
    const long before = faults_so_far();
    for (std::size_t i = 0; i < bytes_; i += kPage)
      data()[i] = 1;
    return faults_so_far() - before;
  }

 private:
  std::size_t bytes_;
  void* data_;
};

TEST(Pages, AreThereWhenTheyAreWritten) {
  constexpr std::size_t kBytes = std::size_t{1} << 20;
  constexpr long kPages = kBytes / kPage;
  if (NewMemory(kBytes).faults_of_writing() < kPages / 2)
    GTEST_SKIP() << "this system gives pages before they are asked for";
  NewMemory probe(kBytes);
  if (madvise(probe.data(), kBytes, 23 /* MADV_POPULATE_WRITE */) != 0)
    GTEST_SKIP() << "this system is older than such wishes";
  NewMemory memory(kBytes);
  populate_pages(memory.data(), kBytes);
  EXPECT_LE(memory.faults_of_writing(), kPages / 4);  // sanitizers have pages of their own
}

TEST(Pages, AreNotTakenForALittle) {
  constexpr std::size_t kBytes = std::size_t{1} << 15;
  constexpr long kPages = kBytes / kPage;
  NewMemory memory(kBytes);
  const long before = faults_so_far();
  populate_pages(memory.data(), kBytes);
  EXPECT_LT(faults_so_far() - before, kPages / 2);  // code has pages as well
}

TEST(Pages, WhatStandsThereStays) {
  std::vector<char> all(std::size_t{5} << 20);
  for (std::size_t i = 0; i < all.size(); ++i)
    all[i] = static_cast<char>(i * 7);
  populate_pages(all.data() + 100, all.size() - 200);
  for (std::size_t i = 0; i < all.size(); ++i)
    ASSERT_EQ(all[i], static_cast<char>(i * 7)) << i;
}

TEST(Pages, OfNothing) {
  populate_pages(nullptr, 0);
  EXPECT_TRUE(array_to_fill<std::vector<int>>(0).empty());
}

template <class Array>
class ArraysToFill : public testing::Test {};
using Arrays = testing::Types<std::vector<std::uint32_t>, RawVector<std::uint32_t>>;
TYPED_TEST_SUITE(ArraysToFill, Arrays);

TYPED_TEST(ArraysToFill, KeepWhatTheyHold) {
  TypeParam v;
  for (const std::size_t n : {3u, 100'000u, 100'001u, 1'000'000u, 1'500'000u}) {
    const std::size_t before = v.size();
    resize_to_fill(v, n, std::uint32_t{7});
    ASSERT_EQ(v.size(), n);
    for (std::size_t i = 0; i < before; ++i)
      ASSERT_EQ(v[i], i);
    for (std::size_t i = before; i < n; ++i)
      ASSERT_EQ(v[i], 7);
    std::iota(v.begin(), v.end(), 0u);
  }
  resize_to_fill(v, 10);
  EXPECT_EQ(v.size(), 10u);
}

TYPED_TEST(ArraysToFill, GrowByOneInFewSteps) {
  constexpr std::uint32_t kCount = 3'000'000;
  TypeParam v;
  int steps = 0;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const std::size_t capacity = v.capacity();
    make_room(v);
    v.push_back(i);
    steps += v.capacity() != capacity;
  }
  for (std::uint32_t i = 0; i < kCount; ++i)
    ASSERT_EQ(v[i], i);
  EXPECT_LE(steps, 24);  // twice as large each: 22
}

/// A file that says how much there is says it once: no array is made anew before that is full.
TEST(Pages, OfWhatWasReservedAreEnough) {
  constexpr std::size_t kCount = 200'000;
  std::vector<std::uint32_t> v;
  v.reserve(kCount);
  const std::uint32_t* const first = v.data();
  for (std::uint32_t i = 0; i < kCount; ++i) {
    make_room(v);
    v.push_back(i);
    ASSERT_EQ(v.data(), first) << i;
  }
}

TEST(Pages, OfText) {
  std::string text = "abc";
  resize_to_fill(text, 1'000'000);
  EXPECT_EQ(text.substr(0, 3), "abc");
  EXPECT_EQ(text.find_first_not_of('\0', 3), std::string::npos);
}

}  // namespace
}  // namespace grelha::test
