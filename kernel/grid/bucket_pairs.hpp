#pragma once
// Which primitive stands in which cell: pairs, sorted by bucket, a run of neighbouring cells.

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "kernel/base/raw_vector.hpp"

namespace grelha {

constexpr std::size_t kMostBuckets = 256;
constexpr unsigned kLeastShift = 8;  ///< a bucket has at least 2^8 cells

struct Pair {
  std::uint32_t cell, id;
};

struct PairChunk {
  RawVector<Pair> pairs;             ///< by bucket; within one as they came
  std::vector<std::uint32_t> first;  ///< [buckets + 1]
};

/// Runs of 2^shift cells each, the last perhaps shorter.
struct Buckets {
  std::size_t cells, count;
  unsigned shift = kLeastShift;

  explicit Buckets(std::size_t all) : cells(all) {
    while (((cells - 1) >> shift) >= kMostBuckets)
      ++shift;
    count = ((cells - 1) >> shift) + 1;
  }
  std::size_t begin(std::size_t bucket) const { return bucket << shift; }
  std::size_t end(std::size_t bucket) const { return std::min((bucket + 1) << shift, cells); }
};

/// Puts the pairs of a chunk in the order of their buckets. `first` holds how many each has, and
/// then where they begin.
inline void sort_pairs(const std::vector<Pair>& pairs, unsigned shift, PairChunk& chunk) {
  std::vector<std::uint32_t>& first = chunk.first;
  std::uint32_t sum = 0;
  for (std::uint32_t& f : first)
    sum += std::exchange(f, sum);
  chunk.pairs.resize(pairs.size());
  for (const Pair& pair : pairs)
    chunk.pairs[first[pair.cell >> shift]++] = pair;
  std::copy_backward(first.begin(), first.end() - 1, first.end());
  first[0] = 0;
}

}  // namespace grelha
