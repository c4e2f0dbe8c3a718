#include "kernel/grid/plan.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <utility>

#include "kernel/grid/grid_steps.hpp"
#include "kernel/grid/cell_finder.hpp"
#include "kernel/grid/distance_field.hpp"
#include "kernel/base/parallel_for.hpp"
#include "kernel/shapes/primitives.hpp"

// A store is filled in three passes, each shared among threads that write to places of their own:
// - emit: a chunk of primitives becomes pairs (cell, id), sorted by bucket, a run of neighbouring
//   cells;
// - count: each bucket counts its cells; the sums over buckets say where its lists begin;
// - write: each bucket writes its lists, taking chunks in turn, so that ids ascend, but for
//   triangles, which stand as their blocks want it.

namespace grelha {
namespace {

constexpr std::size_t kChunk = 2048;
constexpr double kEmitShare = .2;  ///< of the time; counting takes next to none
/// entries of one kind in a cell, from which on it is looked through for copies
constexpr std::uint32_t kDense = 1024;
constexpr std::uint64_t kMostEntries = 0xFFFFFF00u;

/// Entries by kind, and rows of boxes; of a bucket, or of all before it.
struct Sums {
  std::array<std::uint64_t, kKinds> entries{};
  std::uint64_t rows = 0;
};

/// State that all passes share.
struct Filling {
  const Primitives& primitives;
  std::span<const std::uint32_t> ids;
  const Grid& grid;           ///< for its cells alone
  std::optional<double> pad;  ///< if set, blocks get boxes, and neighbours share blocks
  int threads;
  BuildProgress& progress;
  Buckets buckets{cell_count(grid.cells)};
  std::vector<PairChunk> chunks = std::vector<PairChunk>((ids.size() + kChunk - 1) / kChunk);
  std::vector<std::uint8_t> dense = {};  ///< [buckets] 1: of a bucket with a dense cell
  CellStore store = {};
};

/// Calls visit.operator()<Shape>(list, kind's number) for each kind that the store holds any of.
template <class Visit>
void for_each_list(CellStore& store, const Visit& visit) {
  for_each_finite_shape([&]<class Shape>() {
    if (auto& list = store.of<Shape>(); !list.first.empty())
      visit.template operator()<Shape>(list, kNumber<Shape>);
  });
}

/// Calls work(i, state) for i below count, each thread with a state of its own.
template <class State, class Work>
void share_out(const Filling& f, std::size_t count, const Work& work) {
  const auto take = [&](std::size_t i, State& state) {
    if (f.progress.stopped())
      return;
    work(i, state);
    f.progress.step();
  };
  each_turn(
      count, f.threads, [] { return State(); }, take);
  f.progress.throw_if_cancelled();
}

/// Allocates the list starts of each kind that has primitives.
void find_kinds(Filling& f) {
  for_each_finite_shape([&]<class Shape>() {
    const PrimitiveIds& ids = f.primitives.ids;
    const auto first = std::lower_bound(f.ids.begin(), f.ids.end(), ids.begin(Shape::kKind));
    if (first != f.ids.end() && ids.has(Shape::kKind, *first))
      f.store.of<Shape>().first.resize(f.buckets.cells + 1);
  });
}

std::span<const std::uint32_t> ids_of_chunk(const Filling& f, std::size_t index) {
  const std::size_t begin = index * kChunk;
  return f.ids.subspan(begin, std::min(kChunk, f.ids.size() - begin));
}

/// The first pass, of one chunk. `cells_of(id, visit)` names the cells.
template <class CellsOf>
void emit(Filling& f, std::size_t index, const CellsOf& cells_of, std::vector<Pair>& pairs) {
  PairChunk& chunk = f.chunks[index];
  const unsigned shift = f.buckets.shift;
  pairs.clear();
  chunk.first.assign(f.buckets.count + 1, 0);
  for (const std::uint32_t id : ids_of_chunk(f, index))
    cells_of(id, [&](std::size_t c) {
      pairs.push_back({static_cast<std::uint32_t>(c), id});
      ++chunk.first[c >> shift];
    });
  sort_pairs(pairs, shift, chunk);
}

template <class Visit>
void for_each_pair(const Filling& f, std::size_t bucket, const Visit& visit) {
  for (const PairChunk& chunk : f.chunks)
    for (std::uint32_t i = chunk.first[bucket]; i < chunk.first[bucket + 1]; ++i)
      if (chunk.pairs[i].id != kNoPrimitive)
        visit(chunk.pairs[i]);
}

/// Turns primitives of each of a bucket's cells into entries; returns their sums.
Sums count_entries(Filling& f, std::size_t bucket) {
  Sums sums;
  BoxAllocator allocator(0);
  for_each_list(f.store, [&]<class Shape>(ListStore<Shape>& list, std::size_t kind) {
    for (std::size_t c = f.buckets.begin(bucket); c < f.buckets.end(bucket); ++c) {
      std::uint32_t& n = list.first[c];
      f.dense[bucket] |= n > kDense;
      n = ListStore<Shape>::entries_of(n);
      sums.entries[kind] += n;
      if (Shape::kInBlocks && f.pad)
        allocator.take(n);
    }
  });
  sums.rows = allocator.rows();
  return sums;
}

/// The second pass, of one bucket: entries of each of its cells, and their sums.
Sums count(Filling& f, std::size_t bucket) {
  const std::size_t begin = f.buckets.begin(bucket);
  const std::size_t end = f.buckets.end(bucket);
  std::uint32_t* first[kKinds] = {};
  for_each_list(f.store, [&]<class Shape>(ListStore<Shape>& list, std::size_t kind) {
    first[kind] = list.first.data();
    std::fill(first[kind] + begin, first[kind] + end, 0u);
  });
  for_each_pair(f, bucket, [&](const Pair& pair) {
    ++first[static_cast<std::size_t>(f.primitives.kind_of(pair.id))][pair.cell];
  });
  return count_entries(f, bucket);
}

/// Primitives of buckets with a dense cell.
std::vector<std::uint32_t> in_dense_buckets(const Filling& f) {
  std::vector<bool> found(f.primitives.ids.end());
  for (const PairChunk& chunk : f.chunks)
    for (const Pair& pair : chunk.pairs)
      if (f.dense[pair.cell >> f.buckets.shift] != 0)
        found[pair.id] = true;
  std::vector<std::uint32_t> ids;
  std::copy_if(f.ids.begin(), f.ids.end(), std::back_inserter(ids), [&](std::uint32_t id) {
    return found[id];
  });
  return ids;
}

/// Removes copies of primitives in dense cells from all cells; returns true if there were any.
/// A copy has the cells of its original.
bool drop_copies(Filling& f) {
  f.store.copies = find_duplicates(f.primitives, in_dense_buckets(f));
  if (f.store.copies.empty())
    return false;
  std::vector<bool> copies(f.primitives.ids.end());
  for (const Copy& c : f.store.copies)
    copies[c.copy] = true;
  for (PairChunk& chunk : f.chunks)
    for (Pair& pair : chunk.pairs)
      if (copies[pair.id]) {
        pair.id = kNoPrimitive;
        --f.store.references;
      }
  return true;
}

/// Counts all buckets, each by a thread.
void count_buckets(Filling& f, std::vector<Sums>& counts) {
  each_turn(f.buckets.count, f.threads, [&](std::size_t i) { counts[i] = count(f, i); });
}

/// Turns counts into where the lists of each begin; returns their sums.
Sums add_up(std::vector<Sums>& counts) {
  Sums total;
  for (Sums& start : counts) {
    for (std::size_t k = 0; k < kKinds; ++k)
      total.entries[k] += std::exchange(start.entries[k], total.entries[k]);
    total.rows += std::exchange(start.rows, total.rows);
  }
  std::uint64_t most = total.rows * kBlock;
  for (const std::uint64_t n : total.entries)
    most = std::max(most, n);
  if (most > kMostEntries)
    throw std::length_error("the grid's lists are too long: choose a smaller density");
  return total;
}

/// All buckets; returns where the lists of each begin, and makes room for them.
std::vector<Sums> count_all(Filling& f) {
  std::vector<Sums> starts(f.buckets.count);
  for (const PairChunk& c : f.chunks)
    f.store.references += c.pairs.size();
  f.dense.assign(f.buckets.count, 0);
  count_buckets(f, starts);
  const bool any_dense = std::find(f.dense.begin(), f.dense.end(), 1) != f.dense.end();
  if (any_dense && drop_copies(f))
    count_buckets(f, starts);
  const Sums total = add_up(starts);
  for_each_list(f.store, [&]<class Shape>(ListStore<Shape>& list, std::size_t kind) {
    std::uint64_t end = total.entries[kind];
    list.resize(end);
    if constexpr (Shape::kInBlocks)
      if (f.pad) {
        list.resize_boxes(total.rows);
        end = total.rows * kBlock;
      }
    list.first[f.buckets.cells] = static_cast<std::uint32_t>(end);
  });
  return starts;
}

/// A cell's triangles, neighbours in one block; of a list, as they come.
void put_triangles(Filling& f,
                   std::span<const std::uint32_t> ids,
                   std::size_t cell,
                   BlockOrder& order) {
  auto& list = f.store.of<Triangle>();
  const auto& triangles = f.primitives.of<Triangle>();
  const std::uint32_t first_id = f.primitives.ids.begin(PrimitiveKind::kTriangle);
  const std::uint32_t first = list.list().blocks_of(cell).first;
  std::span<const std::uint32_t> places;
  if (f.pad)
    places = order.places(f.primitives, ids, f.grid, cell);
  for (std::size_t i = 0; i < ids.size(); ++i)
    list.put(first, f.pad ? places[i] : i, triangles[ids[i] - first_id], ids[i]);
  if (ids.size() % kBlock != 0)
    list.end_block(first, ids.size());
  if (f.pad)
    bound_blocks(f.grid, *f.pad, cell, static_cast<std::uint32_t>(ids.size()), list);
}

/// Working memory of a thread that writes buckets.
struct Scratch {
  std::vector<std::uint32_t> written;  ///< primitives so far, by kind and cell
  /// ids of the bucket, cell after cell, kBlock for each position
  RawVector<std::uint32_t> triangles;
  BlockOrder order;
};

/// Turns the counts of a bucket's cells into where their lists begin.
void write_lists(Filling& f, std::size_t bucket, const Sums& start, Scratch& scratch) {
  const std::size_t begin = f.buckets.begin(bucket), end = f.buckets.end(bucket);
  for_each_list(f.store, [&]<class Shape>(ListStore<Shape>& list, std::size_t kind) {
    std::uint64_t from = start.entries[kind];
    std::uint64_t sum = from;
    if (Shape::kInBlocks && f.pad) {
      auto& triangles = f.store.of<Triangle>();
      from = start.rows * kBlock;
      sum = kBlock * write_boxes(begin, end, start.rows, start.entries[kind], triangles);
    } else {
      for (std::size_t c = begin; c < end; ++c)
        sum += std::exchange(list.first[c], static_cast<std::uint32_t>(sum));
    }
    if constexpr (Shape::kInBlocks)
      scratch.triangles.resize((sum - from) * kBlock);
  });
}

/// A bucket in the third pass.
class BucketLists {
 public:
  BucketLists(Filling& f, std::size_t bucket, const Sums& start, Scratch& scratch)
      : f_(f),
        bucket_(bucket),
        begin_(f.buckets.begin(bucket)),
        size_(f.buckets.end(bucket) - begin_),
        first_place_(f.pad ? start.rows * kBlock : start.entries[kTriangles]),
        scratch_(scratch) {
    scratch.written.assign(kKinds * size_, 0);
    write_lists(f, bucket, start, scratch);
  }

  /// Writes the lists, but those of triangles: these stand in the scratch.
  void put_primitives() {
    for_each_pair(f_, bucket_, [&](const Pair& pair) {
      f_.primitives.visit(pair.id, [&]<class Shape>(std::uint32_t i) {
        auto& list = f_.store.of<Shape>();
        const std::size_t kind = kNumber<Shape>;
        const std::uint32_t slot = written(kind, pair.cell - begin_)++;
        if constexpr (Shape::kInBlocks)
          triangles_of(pair.cell)[slot] = pair.id;
        else
          list.put(list.first[pair.cell] + slot, f_.primitives.of<Shape>()[i], pair.id);
      });
    });
  }

  /// Writes those of triangles.
  void put_blocks() {
    for (std::size_t i = 0; i < size_; ++i)
      if (const std::uint32_t n = written(kTriangles, i); n != 0)
        put_triangles(f_, {triangles_of(begin_ + i), n}, begin_ + i, scratch_.order);
  }

  /// How many cells hold something; sets `empty`, where given, to 0 for these and 255 for others.
  std::uint64_t count_held(std::uint8_t* empty) {
    std::uint64_t held = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      bool any = false;
      for (std::size_t k = 0; k < kKinds; ++k)
        any |= written(k, i) != 0;
      held += any;
      if (empty)
        empty[begin_ + i] = any ? 0 : 255;
    }
    return held;
  }

 private:
  static constexpr auto kTriangles = kNumber<Triangle>;

  std::uint32_t& written(std::size_t kind, std::size_t i) {
    return scratch_.written[kind * size_ + i];
  }
  std::uint32_t* triangles_of(std::size_t cell) {
    return &scratch_.triangles[(f_.store.of<Triangle>().first[cell] - first_place_) * kBlock];
  }

  Filling& f_;
  const std::size_t bucket_, begin_, size_;
  const std::uint64_t first_place_;  ///< of triangles
  Scratch& scratch_;
};

/// The third pass, of one bucket: its lists; returns how many of its cells hold something. `empty`,
/// where given, becomes 0 for cells that do and 255 for others.
std::uint64_t write(
    Filling& f, std::size_t bucket, const Sums& start, std::uint8_t* empty, Scratch& scratch) {
  BucketLists lists(f, bucket, start, scratch);
  lists.put_primitives();
  lists.put_blocks();
  return lists.count_held(empty);
}

/// All passes, whose time is `share` of the whole build; returns how many cells hold something.
template <class CellsOf>
std::uint64_t fill(Filling& f, const CellsOf& cells_of, std::uint8_t* empty, double share) {
  find_kinds(f);
  f.progress.expect(kEmitShare * share, f.chunks.size());
  share_out<std::vector<Pair>>(
      f, f.chunks.size(), [&](std::size_t i, auto& pairs) { emit(f, i, cells_of, pairs); });
  const std::vector<Sums> starts = count_all(f);
  f.progress.expect((1 - kEmitShare) * share, f.buckets.count);
  std::vector<std::uint64_t> held(f.buckets.count);
  share_out<Scratch>(f, f.buckets.count, [&](std::size_t i, Scratch& scratch) {
    held[i] = write(f, i, starts[i], empty, scratch);
  });
  return std::accumulate(held.begin(), held.end(), std::uint64_t{0});
}

}  // namespace

void fill_grid(const Primitives& p,
               std::span<const std::uint32_t> ids,
               Grid& g,
               int threads,
               BuildProgress& progress,
               double share) {
  const std::size_t cells = cell_count(g.cells);
  const std::size_t fields = distance_fields(cells);
  g.distance.resize(fields * cells + 3);
  const CellFinder finder(p, g);
  Filling filling{p, ids, g, g.pad, thread_count_for(threads, ids.size()), progress};
  g.occupied = fill(filling, finder, g.distance.data(), share);
  g.store = std::move(filling.store);
  compute_distances(g.distance, g.cells, fields, thread_count_for(threads, cells));
  g.levels = build_box_levels(g);
}

CellStore build_list(const Primitives& p, std::span<const std::uint32_t> ids) {
  const Grid one;
  BuildProgress nobody;
  Filling filling{p, ids, one, {}, 1, nobody};
  fill(
      filling, [](std::uint32_t, const auto& visit) { visit(std::size_t{0}); }, nullptr, 0);
  return std::move(filling.store);
}

}  // namespace grelha
