#pragma once
// Rays that go to a point, through its grid: each looks up the tile it goes through, and meets what
// is in it, nearest to the point first.

#include "kernel/trace/point_alone.hpp"

namespace grelha::GRELHA_ISA {

/// One primitive of a kind against all rays of a packet.
template <bool kAny, class In>
inline void test_primitive(Triangle,
                           const GeometryView& g,
                           Packet<In>& p,
                           std::uint32_t i,
                           std::uint32_t id,
                           Counters& n) {
  test_triangle<kAny>(p, triangle_at(g.of<Triangle>(), i), id, n);
}
template <bool kAny, class Shape, class In>
inline void test_primitive(
    Shape, const GeometryView& g, Packet<In>& p, std::uint32_t i, std::uint32_t id, Counters& n) {
  test_one<kAny, Shape>(p, g.of<Shape>().fields, i, id, n);
}

/// Whether anything is in the way of the rays of a packet to a point. `leaves`: the primitive that
/// each ray starts on and is known not to meet, or kNoPrimitive.
class PointSearch {
 public:
  PointSearch(const GeometryView& geometry,
              const PointGridView& grid,
              Packet<InFloat>& p,
              const std::uint32_t* leaves,
              Counters& n)
      : geometry_(geometry), grid_(grid), p_(p), n_(n), alone_(geometry, grid, p, leaves_, n) {
    const int rays = leaves ? p.size : 0;
    if (rays > 0)
      __builtin_memcpy(leaves_, leaves, sizeof *leaves * static_cast<std::size_t>(rays));
    for (int i = rays; i < p.groups * kWidth<Lanes>; ++i)
      leaves_[i] = kNoPrimitive;
  }

  void run() {
    const std::uint64_t live = p_.live;
    prepare_for_all();
    for (std::uint32_t i = 0; i < grid_.around_count; ++i)
      test(grid_.around[i]);
    look_up_all();
    fetch_lists();
    each_live_group(p_, [&](int, int group) { search(group); });
    p_.live = live;
    alone_.run();
  }

 private:
  /// Rays that look into one tile, up to which each goes through its lists by itself: for more of
  /// them windows pay (measured).
  static constexpr int kFew = 5;
  static constexpr int kGroupCount = kPacket / kWidth<Lanes>;

  Mask<Lanes> searches(int i) const { return load<Lanes>(p_.best + i) > load<Lanes>(p_.t_min + i); }

  void look_up_all() {
    each_live_group(p_, [&](int i, int group) {
      const Vec3<Lanes> org{
          load<Lanes>(p_.org[0] + i),
          load<Lanes>(p_.org[1] + i),
          load<Lanes>(p_.org[2] + i),
      };
      places_[group] = look_up(grid_, org, searches(i));
      each_tile(places_[group].tile, [&](std::uint32_t tile, const Mask<Lanes>&) {
        __builtin_prefetch(grid_.tiles + tile);
      });
    });
  }

  /// Asks for the first block of a list.
  template <class Listed>
  static void fetch_list(const Listed* blocks, const TileLists* tile, int kind) {
    if (tile[0].first[kind] == tile[1].first[kind])
      return;
    const char* const bytes = reinterpret_cast<const char*>(blocks + tile->first[kind] / kBlock);
    for (std::size_t line = 0; line < sizeof *blocks; line += 64)
      __builtin_prefetch(bytes + line);
  }

  /// Lists come from afar: all are asked for before the first is looked at.
  void fetch_lists() const {
    each_live_group(p_, [&](int, int group) {
      each_tile(places_[group].tile, [&](std::uint32_t tile, const Mask<Lanes>&) {
        fetch_list(grid_.outlines, grid_.tiles + tile, kOutlineList);
        fetch_list(grid_.boxes, grid_.tiles + tile, kBoxList);
      });
    });
  }

  void search(int group) {
    group_ = group;
    tested_ = kNoPrimitive;
    prepared_ = grid_.around_count > 0;
    p_.live = std::uint64_t{1} << group;
    search_tiles(0, places_[group]);
  }

  /// The tiles that rays of the group look into, of which number `first` is 0 there.
  void search_tiles(std::uint32_t first, const SearchPlaces& at) {
    unsigned lone = 0;
    each_tile(at.tile, [&](std::uint32_t tile, const Mask<Lanes>& here) {
      const TileLists* const lists = grid_.tiles + first + tile;
      if (lists->columns != 0)
        return search_parts(*lists, at, here);
      ++n_.visits;
      if (__builtin_popcount(bits(here)) <= kFew)
        lone |= bits(here);
      else
        search_lists(lists, at, here);
    });
    if (lone != 0)
      alone_.add(to_words(at.tile) + first, at, first_ray(), lone);
  }

  void search_lists(const TileLists* lists, const SearchPlaces& at, const Mask<Lanes>& here) {
    search_list<kOutlineList>(grid_.outlines, lists, at, here);
    search_list<kBoxList>(grid_.boxes, lists, at, here);
  }

  [[gnu::noinline]] void search_parts(const TileLists& whole,
                                      const SearchPlaces& at,
                                      const Mask<Lanes>& here) {
    search_tiles(whole.part, look_closer(at, here, static_cast<float>(whole.columns)));
  }

  /// Depths of the lanes that still search.
  Lanes depths(const SearchPlaces& at, const Mask<Lanes>& here) const {
    return select(both(here, searches(first_ray())), at.depth, Lanes(-kInfinity));
  }

  template <int kKind, class Listed>
  [[gnu::always_inline]] void search_list(const Listed* blocks,
                                          const TileLists* tile,
                                          const SearchPlaces& at,
                                          const Mask<Lanes>& here) {
    std::uint32_t first = tile[0].first[kKind];
    const std::uint32_t end = tile[1].first[kKind];
    if (first == end)
      return;
    Lanes depth = depths(at, here);
    TileWindow w = window_around(at, here, depth);
    for (; first < end; first = (first / kBlock + 1) * kBlock) {
      const Listed& b = blocks[first / kBlock];
      const ShownLanes lanes = shown(w, b, first, end);
      if (lanes.shown != 0 && meet(at, depth, b, lanes.shown)) {
        depth = depths(at, here);
        w.depth = lane_max(depth);
      }
      if (!lanes.all_near || !(w.depth >= 0))
        return;
    }
  }

  /// The group against those primitives of a block that are shown; false: none may be met. No
  /// branch for each: nobody can foretell them.
  template <class Listed>
  [[gnu::always_inline]] bool meet(const SearchPlaces& at,
                                   const Lanes& depth,
                                   const Listed& b,
                                   unsigned shown) {
    struct {
      std::uint32_t id;
      unsigned lanes;
    } unsure[kBlock];
    int count = 0;
    Mask<Lanes> blocked = depth != depth;
    Lanes by(0);
    for (; shown != 0; shown &= shown - 1) {
      const unsigned k = static_cast<unsigned>(__builtin_ctz(shown));
      const MetLanes met = met_lanes(at, depth, b, k);
      const Mask<Lanes> leaves = leaving(b.id[k]);
      const Mask<Lanes> surely = but_not(met.surely, leaves);
      blocked = either(blocked, surely);
      by = select(surely, Lanes(bits_of(b.id[k])), by);
      unsure[count] = {b.id[k], bits(but_not(but_not(met.maybe, leaves), surely))};
      count += unsure[count].lanes != 0;
    }
    const unsigned done = bits(blocked);
    if (done != 0)
      block(blocked, by);
    bool any_tested = false;
    for (int i = 0; i < count; ++i)
      if ((unsure[i].lanes & ~done) != 0) {
        test(unsure[i].id);
        any_tested = true;
      }
    return done != 0 || any_tested;
  }

  int first_ray() const { return group_ * kWidth<Lanes>; }

  /// Lanes whose ray starts on a primitive.
  Mask<Lanes> leaving(std::uint32_t id) const {
    return mask_of(Words<Lanes>(load_words<Lanes>(leaves_ + first_ray()) == id));
  }

  /// Notes that lanes of the group are blocked.
  [[gnu::always_inline]] void block(const Mask<Lanes>& lanes, const Lanes& by) {
    const int i = first_ray();
    store(p_.best + i, select(lanes, Lanes(-kInfinity), load<Lanes>(p_.best + i)));
    store(p_.id + i, select(lanes, by, load<Lanes>(p_.id + i)));
  }

  [[gnu::noinline]] void test(std::uint32_t id) {
    if (id == tested_)
      return;
    tested_ = id;
    prepare_triangles();
    visit_shape(FiniteShapes{}, geometry_.ids, id, [&]<class Shape>(std::uint32_t i) {
      test_primitive<true>(Shape{}, geometry_, p_, i, id, n_);
    });
  }

  void prepare_triangles() {
    if (prepared_)
      return;
    prepared_ = true;
    prepare_to_test(p_, group_, true);
  }
  void prepare_for_all() {
    if (grid_.around_count > 0)
      each_live_group(p_, [&](int, int group) { prepare_to_test(p_, group, true); });
    prepared_ = true;
  }

  const GeometryView& geometry_;
  const PointGridView& grid_;
  Packet<InFloat>& p_;
  Counters& n_;
  int group_ = 0;
  std::uint32_t tested_ = kNoPrimitive;  ///< the last primitive that the group was tested against
  bool prepared_ = false;                ///< rays of the group are ready for triangles
  SearchPlaces places_[kGroupCount];
  alignas(64) std::uint32_t leaves_[kPacket];  ///< or kNoPrimitive
  LoneSearch alone_;
};

}  // namespace grelha::GRELHA_ISA
