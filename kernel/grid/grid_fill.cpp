#include "kernel/grid/grid_fill.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "kernel/grid/block_box.hpp"
#include "kernel/grid/block_order.hpp"
#include "kernel/grid/build_progress.hpp"
#include "kernel/grid/cell_finder.hpp"
#include "kernel/grid/distance_field.hpp"
#include "kernel/grid/grid_layout.hpp"
#include "kernel/shapes/copies.hpp"

namespace grelha {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

void put_triangle(TriangleBlock& block, std::size_t at, const Primitives& p, std::uint32_t id) {
  const TriangleSpans& t = p.geometry.triangles;
  const std::uint32_t i = id - p.triangle_base, v[3] = {t.a[i], t.b[i], t.c[i]};
  float(*const corner[3])[kBlock] = {block.a, block.b, block.c};
  for (int k = 0; k < 3; ++k) {
    corner[k][0][at] = t.x[v[k]];
    corner[k][1][at] = t.y[v[k]];
    corner[k][2][at] = t.z[v[k]];
  }
  block.id[at] = id;
}

/// Places from `used` on hold nothing.
void pad_block(TriangleBlock& block, std::size_t used) {
  for (std::size_t i = used; i < kBlock; ++i) {
    for (int a = 0; a < 3; ++a)
      block.a[a][i] = block.b[a][i] = block.c[a][i] = kNaN;
    block.id[i] = kNoPrimitive;
  }
}

/// Fills a store in three passes, each shared among threads that write to places of their own:
/// - a chunk of primitives becomes pairs (cell, id), sorted by bucket, a run of neighbouring
///   cells;
/// - each bucket counts its cells; the sums over buckets are the places where its lists begin;
/// - each bucket writes its lists, taking chunks in turn, so that ids ascend, but for triangles,
///   which stand as their blocks want it.
class Filling {
 public:
  /// With `pad`, blocks get boxes, and neighbours share them.
  Filling(const Primitives& p,
          std::span<const std::uint32_t> ids,
          const Grid& grid,
          std::optional<double> pad,
          int threads,
          BuildProgress& progress,
          double share)
      : p_(p),
        ids_(ids),
        grid_(grid),
        pad_(pad),
        cells_(cell_count(grid.cells)),
        threads_(threads),
        progress_(progress),
        share_(share) {
    while (((cells_ - 1) >> shift_) >= kMostBuckets)
      ++shift_;
    buckets_ = ((cells_ - 1) >> shift_) + 1;
    chunks_.resize((ids.size() + kChunk - 1) / kChunk);
  }

  /// `cells_of(id, visit)` names the cells. `empty`, where given, becomes 0 for cells that hold
  /// something and 255 for others.
  template <class CellsOf>
  CellStore run(const CellsOf& cells_of, std::uint8_t* empty, std::uint64_t& occupied) {
    for (int kind = 0; kind < 3; ++kind) {
      const auto first = std::lower_bound(ids_.begin(),
                                          ids_.end(),
                                          kind == 0   ? 0
                                          : kind == 1 ? p_.triangle_base
                                                      : p_.cone_base);
      has_[kind] = first != ids_.end() && static_cast<int>(kind_of(p_, *first)) == kind;
      if (has_[kind])
        firsts(kind).resize(cells_ + 1);
    }
    const auto chunks = static_cast<std::ptrdiff_t>(chunks_.size()),
               buckets = static_cast<std::ptrdiff_t>(buckets_);
    std::vector<std::array<std::uint64_t, 3>> sums(buckets_);
    std::uint64_t taken = 0;
    // An exception cannot leave a thread: the first is kept and thrown again behind the loops.
    std::exception_ptr trouble;
    const auto guarded = [&](const auto& work) {
      try {
        if (progress_.stopped())
          return;
        work();
        progress_.step();
      } catch (...) {
#pragma omp critical
        trouble = std::current_exception();
      }
    };
    progress_.expect(kEmitShare * share_, chunks_.size());
#pragma omp parallel num_threads(threads_)
    {
      std::vector<Pair> pairs;
#pragma omp for schedule(dynamic)
      for (std::ptrdiff_t i = 0; i < chunks; ++i)
        guarded([&] { emit(static_cast<std::size_t>(i), cells_of, pairs); });
    }
    if (trouble)
      std::rethrow_exception(trouble);
    progress_.throw_if_stopped();
    const auto count_all = [&] {
#pragma omp parallel for schedule(dynamic) num_threads(threads_)
      for (std::ptrdiff_t i = 0; i < buckets; ++i)
        sums[static_cast<std::size_t>(i)] = count(static_cast<std::size_t>(i));
    };
    for (const Chunk& c : chunks_)
      store_.references += c.pairs.size();
    crowded_.assign(buckets_, 0);
    count_all();
    if (std::any_of(crowded_.begin(), crowded_.end(), [](std::uint8_t c) { return c != 0; }) &&
        drop_copies())
      count_all();
    std::array<std::uint64_t, 3> total{};
    for (auto& sum : sums)
      for (std::size_t k = 0; k < 3; ++k)
        total[k] += std::exchange(sum[k], total[k]);
    for (const std::uint64_t n : total)
      if (n > 0xFFFFFF00u)
        throw std::length_error("the grid's lists are too long: choose a smaller density");
    make_room(total);
    progress_.expect((1 - kEmitShare) * share_, buckets_);
#pragma omp parallel num_threads(threads_)
    {
      Room room;
#pragma omp for schedule(dynamic) reduction(+ : taken)
      for (std::ptrdiff_t i = 0; i < buckets; ++i)
        guarded([&] {
          taken +=
              write(static_cast<std::size_t>(i), sums[static_cast<std::size_t>(i)], room, empty);
        });
    }
    if (trouble)
      std::rethrow_exception(trouble);
    progress_.throw_if_stopped();
    occupied = taken;
    return std::move(store_);
  }

 private:
  static constexpr std::size_t kChunk = 2048, kMostBuckets = 256;
  static constexpr double kEmitShare = .2;  ///< of the time; counting takes next to none
  /// entries of one kind in a cell, from which on it is looked through for copies
  static constexpr std::uint32_t kCrowded = 1024;
  struct Pair {
    std::uint32_t cell, id;
  };
  struct Chunk {
    RawVector<Pair> pairs;             ///< by bucket; within one as they came
    std::vector<std::uint32_t> first;  ///< [buckets + 1]
  };

  RawVector<std::uint32_t>& firsts(int kind) {
    return kind == 0 ? store_.sphere_first : kind == 1 ? store_.triangle_first : store_.cone_first;
  }
  std::size_t begin_of(std::size_t bucket) const { return bucket << shift_; }
  std::size_t end_of(std::size_t bucket) const { return std::min((bucket + 1) << shift_, cells_); }

  template <class CellsOf>
  void emit(std::size_t index, const CellsOf& cells_of, std::vector<Pair>& pairs) {
    Chunk& chunk = chunks_[index];
    pairs.clear();
    chunk.first.assign(buckets_ + 1, 0);
    for (std::size_t i = index * kChunk; i < std::min((index + 1) * kChunk, ids_.size()); ++i)
      cells_of(ids_[i], [&](std::size_t c) {
        pairs.push_back({static_cast<std::uint32_t>(c), ids_[i]});
        ++chunk.first[c >> shift_];
      });
    std::uint32_t sum = 0;
    for (std::uint32_t& f : chunk.first)
      sum += std::exchange(f, sum);
    chunk.pairs.resize(pairs.size());
    for (const Pair& pair : pairs)
      chunk.pairs[chunk.first[pair.cell >> shift_]++] = pair;
    for (std::size_t b = buckets_; b > 0; --b)
      chunk.first[b] = chunk.first[b - 1];
    chunk.first[0] = 0;
  }

  template <class Visit>
  void each_pair(std::size_t bucket, const Visit& visit) const {
    for (const Chunk& chunk : chunks_)
      for (std::uint32_t i = chunk.first[bucket]; i < chunk.first[bucket + 1]; ++i)
        if (chunk.pairs[i].id != kNoPrimitive)
          visit(chunk.pairs[i]);
  }

  /// Takes from all cells what is a copy of something in the crowded ones; whether there was any. A
  /// copy has the cells of its original.
  bool drop_copies() {
    std::vector<bool> in_crowds(p_.end), copies(p_.end);
    for (const Chunk& chunk : chunks_)
      for (const Pair& pair : chunk.pairs)
        if (crowded_[pair.cell >> shift_] != 0)
          in_crowds[pair.id] = true;
    std::vector<std::uint32_t> ids;
    std::copy_if(ids_.begin(), ids_.end(), std::back_inserter(ids), [&](std::uint32_t id) {
      return in_crowds[id];
    });
    const std::vector<std::uint32_t> found = copies_among(p_, ids);
    for (const std::uint32_t id : found)
      copies[id] = true;
    for (Chunk& chunk : chunks_)
      for (Pair& pair : chunk.pairs)
        if (!found.empty() && copies[pair.id]) {
          pair.id = kNoPrimitive;
          --store_.references;
        }
    return !found.empty();
  }

  /// Entries of each cell (blocks, of triangles), and their sums over the bucket.
  std::array<std::uint64_t, 3> count(std::size_t bucket) {
    std::array<std::uint64_t, 3> sums{};
    std::uint32_t* n[3] = {};
    for (int k = 0; k < 3; ++k)
      if (has_[k]) {
        n[k] = firsts(k).data();
        std::fill(n[k] + begin_of(bucket), n[k] + end_of(bucket), 0u);
      }
    each_pair(bucket,
              [&](const Pair& pair) { ++n[static_cast<int>(kind_of(p_, pair.id))][pair.cell]; });
    for (int k = 0; k < 3; ++k)
      for (std::size_t c = begin_of(bucket); n[k] && c < end_of(bucket); ++c)
        crowded_[bucket] |= n[k][c] > kCrowded;
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t c = begin_of(bucket); n[k] && c < end_of(bucket); ++c) {
        if (k == 1)
          n[k][c] = (n[k][c] + kBlock - 1) / kBlock;
        sums[k] += n[k][c];
      }
    return sums;
  }

  void make_room(const std::array<std::uint64_t, 3>& total) {
    const auto padded = [&](auto& arrays, auto& ids, std::uint64_t n) {
      for (auto& v : arrays) {
        v.resize(n + kBlock);
        std::fill(v.begin() + static_cast<std::ptrdiff_t>(n), v.end(), kNaN);
      }
      ids.resize(n + kBlock);
      std::fill(ids.begin() + static_cast<std::ptrdiff_t>(n), ids.end(), kNoPrimitive);
    };
    if (has_[0])
      padded(store_.spheres, store_.sphere_id, total[0]);
    if (has_[1])
      store_.triangles.resize(total[1]);
    if (has_[1] && pad_) {
      store_.boxes.resize((total[1] + kBlock - 1) / kBlock);
      // places without a block
      for (auto& side : store_.boxes.back().side)
        std::fill(std::begin(side), std::end(side), kNaN);
    }
    if (has_[2])
      padded(store_.cones, store_.cone_id, total[2]);
    for (int k = 0; k < 3; ++k)
      if (has_[k])
        firsts(k)[cells_] = static_cast<std::uint32_t>(total[static_cast<std::size_t>(k)]);
  }

  struct Room {
    std::vector<std::uint32_t> at;  ///< entries written so far, by kind and cell
    /// ids of the bucket, cell after cell, each from a multiple of kBlock on
    RawVector<std::uint32_t> triangles;
    BlockOrder order;
  };

  /// The bucket's lists; returns how many of its cells hold something.
  std::uint64_t write(std::size_t bucket,
                      const std::array<std::uint64_t, 3>& start,
                      Room& room,
                      std::uint8_t* empty) {
    const std::size_t begin = begin_of(bucket), end = end_of(bucket), size = end - begin;
    std::vector<std::uint32_t>& at = room.at;
    at.assign(3 * size, 0);
    std::uint64_t held = 0;
    std::uint32_t* first[3] = {};
    for (std::size_t k = 0; k < 3; ++k) {
      if (!has_[k])
        continue;
      first[k] = firsts(static_cast<int>(k)).data();
      auto sum = static_cast<std::uint32_t>(start[k]);
      for (std::size_t c = begin; c < end; ++c)
        sum += std::exchange(first[k][c], sum);
      if (k == 1)
        room.triangles.resize((sum - start[1]) * kBlock);
    }
    each_pair(bucket, [&](const Pair& pair) {
      const Kind kind = kind_of(p_, pair.id);
      const auto k = static_cast<std::size_t>(kind);
      const std::size_t place = at[k * size + pair.cell - begin]++, from = first[k][pair.cell];
      if (kind == Kind::kTriangle)
        room.triangles[(from - start[1]) * kBlock + place] = pair.id;
      else if (kind == Kind::kSphere)
        put_sphere(from + place, pair.id);
      else
        put_cone(from + place, pair.id);
    });
    for (std::size_t i = 0; i < size; ++i) {
      if (at[size + i] != 0)
        put_triangles(first[1][begin + i],
                      {&room.triangles[(first[1][begin + i] - start[1]) * kBlock], at[size + i]},
                      begin + i,
                      room.order);
      const bool any = (at[i] | at[size + i] | at[2 * size + i]) != 0;
      held += any;
      if (empty)
        empty[begin + i] = any ? 0 : 255;
    }
    return held;
  }

  /// A cell's triangles, neighbours in one block; of a list, as they come.
  void put_triangles(std::uint32_t first,
                     std::span<const std::uint32_t> ids,
                     std::size_t cell,
                     BlockOrder& order) {
    std::span<const std::uint32_t> places;
    if (pad_)
      places = order.places(p_, ids, grid_, cell);
    for (std::size_t i = 0; i < ids.size(); ++i) {
      const std::size_t place = pad_ ? places[i] : i;
      put_triangle(store_.triangles[first + place / kBlock], place % kBlock, p_, ids[i]);
    }
    if (ids.size() % kBlock != 0)
      pad_block(store_.triangles[first + ids.size() / kBlock], ids.size() % kBlock);
    if (pad_)
      bound_blocks(grid_,
                   *pad_,
                   cell,
                   first,
                   static_cast<std::uint32_t>(first + (ids.size() + kBlock - 1) / kBlock),
                   store_);
  }

  void put_sphere(std::size_t to, std::uint32_t id) {
    const SphereSpans& from = p_.geometry.spheres;
    const std::size_t i = id - p_.sphere_base;
    store_.spheres[0][to] = from.x[i];
    store_.spheres[1][to] = from.y[i];
    store_.spheres[2][to] = from.z[i];
    store_.spheres[3][to] = from.radius[i];
    store_.sphere_id[to] = id;
  }
  void put_cone(std::size_t to, std::uint32_t id) {
    for (std::size_t k = 0; k < 10; ++k)
      store_.cones[k][to] = p_.cones[k][id - p_.cone_base];
    store_.cone_id[to] = id;
  }

  const Primitives& p_;
  std::span<const std::uint32_t> ids_;
  const Grid& grid_;  ///< its cells; no more
  std::optional<double> pad_;
  std::size_t cells_, buckets_ = 0;
  unsigned shift_ = 8;
  int threads_;
  BuildProgress& progress_;
  double share_;  ///< of the whole build
  bool has_[3] = {};
  std::vector<Chunk> chunks_;
  std::vector<std::uint8_t> crowded_;  ///< [buckets] 1: of a bucket with a crowded cell
  CellStore store_;
};

}  // namespace

void fill_grid(const Primitives& p,
               std::span<const std::uint32_t> ids,
               Grid& g,
               int threads,
               BuildProgress& progress,
               double share) {
  const std::size_t cells = cell_count(g.cells);
  g.distance.resize(cells + 3);  // so that four bytes can be read from any place
  const CellFinder finder(p, g, g.pad);
  g.store = Filling(p, ids, g, g.pad, useful_threads(threads, ids.size()), progress, share)
                .run([&](std::uint32_t id, const auto& visit) { finder(id, visit); },
                     g.distance.data(),
                     g.occupied);
  chebyshev_distance(g.distance, g.cells, useful_threads(threads, cells));
}

CellStore build_list(const Primitives& p, std::span<const std::uint32_t> ids) {
  std::uint64_t occupied = 0;
  const Grid one;
  BuildProgress nobody;
  return Filling(p, ids, one, {}, 1, nobody, 0)
      .run([](std::uint32_t, const auto& visit) { visit(std::size_t{0}); }, nullptr, occupied);
}

}  // namespace grelha
