#pragma once
// Rays on their way from cell to cell of a grid, each on its own course, side by side.

#include "kernel/walk/course.hpp"

namespace grelha::GRELHA_ISA {

/// Length of arrays: storing chosen lanes writes a full register, past the last one.
inline constexpr int kWayRow = kPacket + kWidth<Lanes>;

/// Rays that came to cells with something in them.
struct Arrivals {
  int count = 0;
  alignas(64) std::uint32_t ray[kWayRow];  ///< places in the packet
  alignas(64) std::uint32_t cell[kWayRow];
};

/// The rays of a packet that are still under way through a grid.
class RaysUnderWay {
 public:
  RaysUnderWay(const GridView& g, const WalkingRays& p) : g_(g), p_(p) {
    each_live_group(p, [&](int i, int) { add(i); });
    going_ = count_;
    fill_up();
  }

  bool any() const { return going_ > 0; }
  int going() const { return going_; }

  /// Notes those whose cells hold something.
  void arrive(Arrivals& to) {
    to.count = 0;
    for (int i = 0; i < count_; i += kWidth<Lanes>)
      arrive(i, to);
  }

  /// Goes on to the next cells.
  void step() {
    going_ = 0;
    for (int i = 0; i < count_; i += kWidth<Lanes>)
      step(i);
    if (2 * going_ <= count_)
      close_ranks();
  }

 private:
  void add(int i) {
    Lanes org[3];
    Lanes dir[3];
    for (int a = 0; a < 3; ++a) {
      org[a] = load<Lanes>(p_.org[a] + i);
      dir[a] = load<Lanes>(p_.dir[a] + i);
    }
    const Lanes begin = greater(load<Lanes>(p_.start + i), load<Lanes>(p_.t_min + i));
    Course<Lanes> c;
    Lanes cell[3];
    const Mask<Lanes> come = enter(g_, org, dir, begin, load<Lanes>(p_.best + i), c, cell);
    const Chosen chosen(bits(come));
    put(chosen, count_, c, cell, counted_words<Lanes>(static_cast<std::uint32_t>(i)), field_of(c));
    count_ += chosen.count();
  }

  /// Start of the distances for the octants of rays.
  Words<Lanes> field_of(const Course<Lanes>& c) const {
    const Lanes o(0);
    Lanes field(1);
    for (int a = 0; a < 3; ++a)
      field = field + select(c.inverse[a] < o, Lanes(static_cast<float>(1 << a)), o);
    return g_.field_places * to_words(field);
  }

  [[gnu::always_inline]] void put(const Chosen& chosen,
                                  int to,
                                  const Course<Lanes>& c,
                                  const Lanes (&cell)[3],
                                  const Words<Lanes>& ray,
                                  const Words<Lanes>& field) {
    for (int a = 0; a < 3; ++a) {
      chosen.store(place_[a] + to, c.place[a]);
      chosen.store(speed_[a] + to, c.speed[a]);
      chosen.store(inverse_[a] + to, c.inverse[a]);
      chosen.store(cell_[a] + to, cell[a]);
    }
    chosen.store(end_ + to, c.end);
    chosen.store(ray_ + to, ray);
    chosen.store(field_ + to, field);
  }

  [[gnu::always_inline]] void arrive(int i, Arrivals& to) {
    const auto at = [&](int a) { return to_words(load<Lanes>(cell_[a] + i)); };
    const auto cells_along = [&](int a) { return static_cast<std::uint32_t>(g_.n[a]); };
    const Words<Lanes> cell = at(0) + cells_along(0) * (at(1) + cells_along(1) * at(2));
    const Lanes distance = bytes_at(g_.distance, load_words<Lanes>(field_ + i) + cell);
    store(distance_ + i, distance);
    const Chosen full(bits(distance == Lanes(0)) & walking(i));
    full.store(to.ray + to.count, load_words<Lanes>(ray_ + i));
    full.store(to.cell + to.count, cell);
    to.count += full.count();
  }

  /// Bits of the lanes from i on that are under way.
  unsigned walking(int i) const {
    return bits(load<Lanes>(end_ + i) > Lanes(-kInfinity)) & lanes_before(i);
  }
  unsigned lanes_before(int i) const {
    const int left = count_ - i;
    return left >= kWidth<Lanes> ? ~0u : (1u << left) - 1u;
  }

  [[gnu::always_inline]] Course<Lanes> course(int i) const {
    Course<Lanes> c;
    for (int a = 0; a < 3; ++a) {
      c.place[a] = load<Lanes>(place_[a] + i);
      c.speed[a] = load<Lanes>(speed_[a] + i);
      c.inverse[a] = load<Lanes>(inverse_[a] + i);
    }
    c.end = load<Lanes>(end_ + i);
    return c;
  }

  [[gnu::always_inline]] void step(int i) {
    Lanes at[3];
    for (int a = 0; a < 3; ++a)
      at[a] = load<Lanes>(cell_[a] + i);
    const Lanes best = floats_at(p_.best, load_words<Lanes>(ray_ + i));
    const Course<Lanes> c = course(i);
    const Mask<Lanes> goes = grelha::GRELHA_ISA::step(g_, c, load<Lanes>(distance_ + i), best, at);
    for (int a = 0; a < 3; ++a)
      store(cell_[a] + i, select(goes, at[a], Lanes(0)));
    // only a ray that is under way has an end
    store(end_ + i, select(goes, c.end, Lanes(-kInfinity)));
    going_ += __builtin_popcount(bits(goes) & lanes_before(i));
  }

  void close_ranks() {
    int to = 0;
    for (int i = 0; i < count_; i += kWidth<Lanes>) {
      const Chosen chosen(walking(i));
      Lanes cell[3];
      for (int a = 0; a < 3; ++a)
        cell[a] = load<Lanes>(cell_[a] + i);
      const Words<Lanes> ray = load_words<Lanes>(ray_ + i);
      put(chosen, to, course(i), cell, ray, load_words<Lanes>(field_ + i));
      to += chosen.count();
    }
    count_ = to;
  }

  /// Makes lanes behind the last ray fit to be computed with; later such lanes hold old rays.
  void fill_up() {
    const int end = count_ + kWidth<Lanes>;
    for (int i = count_; i < end; ++i) {
      for (int a = 0; a < 3; ++a)
        cell_[a][i] = 0;
      end_[i] = -kInfinity;
      ray_[i] = 0;
      field_[i] = 0;
    }
  }

  const GridView& g_;
  const WalkingRays& p_;
  int count_ = 0;
  int going_ = 0;
  alignas(64) float place_[3][kWayRow];
  alignas(64) float speed_[3][kWayRow];
  alignas(64) float inverse_[3][kWayRow];
  alignas(64) float cell_[3][kWayRow];
  alignas(64) float end_[kWayRow];
  alignas(64) float distance_[kWayRow];
  alignas(64) std::uint32_t ray_[kWayRow];
  alignas(64) std::uint32_t field_[kWayRow];
};

}  // namespace grelha::GRELHA_ISA
