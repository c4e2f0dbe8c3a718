#pragma once
// What rays may cross, ray by ray, and lists of what many of them find.

#include <algorithm>
#include <mutex>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "kernel/grid/world_impl.hpp"
#include "kernel/query/filters.hpp"
#include "kernel/query/runs.hpp"
#include "kernel/query/variants.hpp"
#include "kernel/traverse/packet.hpp"

namespace grelha {

/// Calls visit(i, candidates) for each ray i, with its candidates, each once.
template <class Visit>
class CandidatesByRay final : public CandidateSink {
 public:
  CandidatesByRay(Wanted what, const Visit& visit) : CandidateSink(what), visit_(visit) {
    items = few_;
    capacity = std::size(few_);
  }
  CandidatesByRay(const CandidatesByRay&) = delete;  ///< `items` may point into it

  void make_room() override {
    if (items == few_)
      many_.assign(few_, few_ + count);
    many_.resize(2 * capacity);
    items = many_.data();
    capacity = many_.size();
  }

  void end_packet(std::size_t first, int rays) override {
    std::uint32_t end[kMostRays + 1] = {};  // of the candidates of each ray, after the second loop
    for (std::size_t k = 0; k < count; ++k)
      ++end[items[k].ray + 1];
    for (int i = 0; i < rays; ++i)
      end[i + 1] += end[i];
    if (sorted_.size() < count)
      sorted_.resize(capacity);
    for (std::size_t k = 0; k < count; ++k)
      sorted_[end[items[k].ray]++] = items[k];
    Candidate* begin = sorted_.data();
    for (int i = 0; i < rays; ++i) {
      Candidate* const last = sorted_.data() + end[i];
      visit_(first + static_cast<std::size_t>(i), each_once({begin, last}));
      begin = last;
    }
    count = 0;
  }

 private:
  static constexpr std::size_t kMostRays = 256;  ///< of a packet

  /// Ids that were seen, by open addressing; of this ray where the stamp is the last one.
  struct Seen {
    std::uint32_t id = 0;
    std::uint32_t stamp = 0;
  };
  static constexpr int kSeenBits = 9;
  static constexpr std::uint32_t kSeen = 1u << kSeenBits;

  /// The first candidate of each primitive.
  std::span<const Candidate> each_once(std::span<Candidate> all) {
    if (all.size() < 2)
      return all;
    if (all.size() > kSeen / 2)
      return sorted_once(all);
    ++stamp_;
    Candidate* to = all.data();
    for (const Candidate& c : all) {
      std::uint32_t at = c.id * 0x9E3779B1u >> (32 - kSeenBits);
      while (seen_[at].stamp == stamp_ && seen_[at].id != c.id)
        at = (at + 1) % kSeen;
      if (seen_[at].stamp == stamp_)
        continue;
      seen_[at] = {c.id, stamp_};
      *to++ = c;
    }
    return {all.data(), to};
  }
  static std::span<const Candidate> sorted_once(std::span<Candidate> all) {
    std::sort(
        all.begin(), all.end(), [](const Candidate& a, const Candidate& b) { return a.id < b.id; });
    const auto last = std::unique(
        all.begin(), all.end(), [](const auto& a, const auto& b) { return a.id == b.id; });
    return {all.begin(), last};
  }

  const Visit& visit_;
  Candidate few_[64];
  std::vector<Candidate> many_;
  std::vector<Candidate> sorted_;
  Seen seen_[kSeen];
  std::uint32_t stamp_ = 0;
};

/// Calls visit(i, candidates) for each ray of a view, as CandidatesByRay does.
template <class Visit>
void visit_candidates(const Variant& variant,
                      const World& world,
                      const Rays& rays,
                      Wanted wanted,
                      const Visit& visit) {
  CandidatesByRay<Visit> by_ray(wanted, visit);
  variant.loops.collect(world.impl().view, rays, by_ray);
}

/// What a List is for: made of a world, set() to a ray and what it leaves out, it makes of the
/// candidates what a query asks for. Calls visit(i, list, candidates) for the rays [first, end).
template <class List, class Visit>
void visit_run(const Variant& variant,
               const World& world,
               const Rays& rays,
               const QueryOptions& options,
               std::size_t first,
               std::size_t end,
               const Visit& visit) {
  List list(world);
  const Rays run = part_of(rays, first, end);
  visit_candidates(variant, world, run, List::kWanted, [&](std::size_t k, auto candidates) {
    const std::size_t i = first + k;
    list.set(ray_of(rays, i), filter_of(rays, options, i));
    visit(i, list, candidates);
  });
}

/// Counts what a List finds of each ray; `query`: who asks.
template <class List>
void count_each(const World& world,
                const Rays& rays,
                std::uint32_t* counts,
                const QueryOptions& options,
                const char* query) {
  expect_arrays(rays);
  expect_masks(world, options.mask);
  if (!counts && rays.count > 0)
    throw std::invalid_argument(std::string(query) + ": expected an array of counts, found null");
  const Variant& variant = choose_variant(options.isa);
  each_run(rays.count, options, [&](std::size_t first, std::size_t end) {
    visit_run<List>(variant, world, rays, options, first, end, [&](auto i, List& list, auto all) {
      counts[i] = list.count(all);
    });
  });
}

/// Sorts crossings by is_before(), which tells the order of two whose intervals overlap. Most do
/// not: they are sorted by their lower ends first.
template <class Item, class IsBefore>
void sort_crossings(std::vector<Item>& items, const IsBefore& is_before) {
  std::sort(items.begin(), items.end(), [](const Item& a, const Item& b) {
    return a.lo != b.lo ? a.lo < b.lo : a.id < b.id;
  });
  for (std::size_t i = 1; i < items.size(); ++i) {
    if (items[i - 1].hi < items[i].lo)
      continue;
    const Item one = items[i];
    std::size_t to = i;
    for (; to > 0 && is_before(one, items[to - 1]); --to)
      items[to] = items[to - 1];
    items[to] = one;
  }
}

/// Puts what a List finds of each ray one after another; offset[i]: where that of ray i begins,
/// [count + 1].
template <class List, class Item>
void list_each(const World& world,
               const Rays& rays,
               const QueryOptions& options,
               std::vector<std::size_t>& offset,
               std::vector<Item>& items) {
  expect_arrays(rays);
  expect_masks(world, options.mask);
  const Variant& variant = choose_variant(options.isa);
  struct RunItems {
    std::size_t first;
    std::vector<Item> items;
  };
  std::vector<RunItems> parts;
  std::mutex mutex;
  offset.assign(rays.count + 1, 0);
  each_run(rays.count, options, [&](std::size_t first, std::size_t end) {
    RunItems part{first, {}};
    visit_run<List>(variant, world, rays, options, first, end, [&](auto i, List& list, auto all) {
      const std::size_t before = part.items.size();
      list.find(all, part.items);
      offset[i + 1] = part.items.size() - before;
    });
    const std::lock_guard lock(mutex);
    parts.push_back(std::move(part));
  });
  for (std::size_t i = 0; i < rays.count; ++i)
    offset[i + 1] += offset[i];
  if (parts.size() == 1) {
    items = std::move(parts[0].items);
    return;
  }
  items.resize(offset.back());
  for (const RunItems& part : parts)
    std::copy(part.items.begin(),
              part.items.end(),
              items.begin() + static_cast<std::ptrdiff_t>(offset[part.first]));
}

/// What a List finds of one ray.
template <class List, class Item>
std::vector<Item> list_one(const World& world, const Ray& ray, const Filter& filter) {
  expect_masks(world, filter.masks);
  std::vector<Item> items;
  List list(world);
  list.set(ray, filter);
  const auto find = [&](std::size_t, auto candidates) { list.find(candidates, items); };
  visit_candidates(best_variant(), world, Rays::of({&ray, 1}), List::kWanted, find);
  return items;
}

}  // namespace grelha
