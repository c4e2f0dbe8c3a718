#pragma once
// What rays cross, ray by ray: triangles that a ray moved aside crosses, rays of queries that list,
// and lists of what many of them find.

#include <algorithm>
#include <mutex>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "grelha/query.hpp"
#include "kernel/shapes/triangle.hpp"
#include "kernel/world/world_impl.hpp"
#include "kernel/traverse/ray.hpp"
#include "kernel/query/streams.hpp"
#include "kernel/query/variants.hpp"
#include "kernel/traverse/packet.hpp"

namespace grelha {

/// crosses_perturbed(), by doubles where they tell.
inline bool crosses_perturbed(const ExactRay& ray, const Triangle::Fields<float>& triangle) {
  const scalar::HitInterval<double> bound = scalar::bound_triangle(ray, triangle.corner);
  if (!bound.some || bound.lo >= ray.t_max)
    return false;
  return (bound.sure && bound.hi < ray.t_max) || crosses_perturbed(ray, triangle.corner);
}

/// A normal times a direction in double: error <= kFacingError * sum of the sizes of products, 8 u.
inline constexpr double kFacingError = 16 * 0x1p-53;

/// crosses_front(), by doubles where they tell.
inline bool is_crossed_inwards(const ExactRay& ray, const float (&corner)[3][3]) {
  double sum = 0;
  double size = 0;
  for (int a = 0; a < 3; ++a) {
    const int y = scalar::kNextAxis[a];
    const int z = scalar::kPreviousAxis[a];
    const auto edge = [&](int k, int axis) {
      return double{corner[k][axis]} - double{corner[0][axis]};
    };
    const double first = edge(1, y) * edge(2, z);
    const double second = edge(1, z) * edge(2, y);
    sum += (first - second) * ray.dir[a];
    size += (std::abs(first) + std::abs(second)) * std::abs(ray.dir[a]);
  }
  return std::abs(sum) > kFacingError * size ? sum < 0 : crosses_front(ray, corner);
}

/// A ray whose direction has a length that exact tests can work with, as lists need it.
class ListedRay {
 public:
  explicit ListedRay(const World& world) : scene_(world.impl().view) {}
  void set(const Ray& ray, const Filter& filter) {
    ray_ = ray;
    filter_ = filter;
    is_scaled_ = false;
  }

 protected:
  /// Calls visit(id) for a primitive and its copies, as far as the ray does not leave them out.
  template <class Visit>
  void each_passing(std::uint32_t id, const Visit& visit) const {
    const auto pass = [&](std::uint32_t one) {
      if (one != filter_.skip &&
          (filter_.masks.empty() || (filter_.masks[one] & filter_.mask) != 0))
        visit(one);
    };
    pass(id);
    const CopyTable& copies = scene_.copies;
    for (std::uint32_t i = copies.begin(id); copies.has(i, id); ++i)
      pass(copies.pair[i].copy);
  }

  /// The ray as the tests of packets have it: t counts multiples of `unit`.
  const ExactRay& scaled() {
    if (!is_scaled_) {
      const scalar::Vec3<float> dir{ray_.dir.x, ray_.dir.y, ray_.dir.z};
      const float unit = scalar::direction_scale(dir);
      const double by = unit;
      const float t_max = unit == 1 ? ray_.t_max : scalar::finite_end(unit, ray_.t_max);
      scaled_ = {{ray_.org.x, ray_.org.y, ray_.org.z},
                 {dir.x / unit, dir.y / unit, dir.z / unit},
                 by * ray_.t_min,
                 by * t_max};
      unit_ = unit;
      is_scaled_ = true;
    }
    return scaled_;
  }
  /// t of a crossing that lies from lo to hi of a scaled ray, rounded once. Where that does not
  /// tell, exactly(ray) does, the ray being in its own length.
  template <class Exactly>
  float rounded(const ExactRay& ray, double lo, double hi, const Exactly& exactly) const {
    const auto first = static_cast<float>(lo);
    const bool known = unit_ == 1 && first == static_cast<float>(hi);
    const float t = (known ? first : exactly(ray.in_units_of(1 / unit_))) + 0.f;  // no zero is -0
    return scalar::strictly_between(t, ray_.t_min, ray_.t_max);
  }

  /// Bounds t of a triangle that the ray surely crosses. Returns false where doubles do not tell.
  bool bound_plane(const Candidate& c, double& lo, double& hi) {
    const Triangle::Fields<float> triangle = scalar::triangle_of(*c.block, c.index);
    const scalar::PlaneSpan<double> span =
        scalar::plane_span<double>(scalar::vec(scaled().org),
                                   scalar::vec(scaled().dir),
                                   {scalar::vec_double(triangle.corner[0]),
                                    scalar::vec_double(triangle.corner[1]),
                                    scalar::vec_double(triangle.corner[2])});
    lo = span.lo;
    hi = span.hi;
    return span.known;
  }

  const SceneView& scene_;
  Filter filter_;

 private:
  Ray ray_{};
  ExactRay scaled_{};
  double unit_ = 1;
  bool is_scaled_ = false;
};

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
  const Rays run = rays.part(first, end);
  visit_candidates(variant, world, run, List::kWanted, [&](std::size_t k, auto candidates) {
    const std::size_t i = first + k;
    list.set(rays[i], filter_of(rays, options, i));
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
