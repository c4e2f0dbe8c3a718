#pragma once
// Rays on their way from cell to cell of a grid, each with a DDA state of its own, side by side.

#include "kernel/traverse/dda.hpp"

namespace grelha::GRELHA_ISA {

/// Length of arrays: storing selected lanes writes a full register, past the last one.
inline constexpr int kActiveRow = kPacket + kWidth<VFloat>;

/// Rays that came to cells with something in them.
struct LeafQueue {
  int count = 0;
  alignas(64) std::uint32_t ray[kActiveRow];  ///< indices in the packet
  alignas(64) std::uint32_t cell[kActiveRow];
};

/// The rays of a packet that are still under way through a grid.
class ActiveRays {
 public:
  ActiveRays(const GridView& g, const Packet& p) : g_(g), p_(p) {
    each_live_group(p, [&](int i, int) { add(i); });
    going_ = count_;
    fill_up();
  }

  bool any() const { return going_ > 0; }
  int going() const { return going_; }

  /// Notes those whose cells hold something.
  void enqueue(LeafQueue& to) {
    to.count = 0;
    for (int i = 0; i < count_; i += kWidth<VFloat>)
      enqueue(i, to);
  }

  /// Goes on to the next cells.
  void step() {
    going_ = 0;
    for (int i = 0; i < count_; i += kWidth<VFloat>)
      step(i);
    if (2 * going_ <= count_)
      close_ranks();
  }

 private:
  void add(int i) {
    VFloat org[3];
    VFloat dir[3];
    for (int a = 0; a < 3; ++a) {
      org[a] = load<VFloat>(p_.org[a] + i);
      dir[a] = load<VFloat>(p_.dir[a] + i);
    }
    const VFloat begin = max(load<VFloat>(p_.start + i), load<VFloat>(p_.t_min + i));
    DdaState<VFloat> c;
    VFloat cell[3];
    const Mask<VFloat> come = enter(g_, org, dir, begin, load<VFloat>(p_.best + i), c, cell);
    const CompressMask selected(bits(come));
    put(selected,
        count_,
        c,
        cell,
        counted_words<VFloat>(static_cast<std::uint32_t>(i)),
        field_of(c));
    count_ += selected.count();
  }

  /// Start of the distances for the octants of rays.
  Words<VFloat> field_of(const DdaState<VFloat>& c) const {
    const VFloat o(0);
    VFloat field(1);
    for (int a = 0; a < 3; ++a)
      field = field + select(c.inverse[a] < o, VFloat(static_cast<float>(1 << a)), o);
    return g_.field_stride * to_words(field);
  }

  [[gnu::always_inline]] void put(const CompressMask& selected,
                                  int to,
                                  const DdaState<VFloat>& c,
                                  const VFloat (&cell)[3],
                                  const Words<VFloat>& ray,
                                  const Words<VFloat>& field) {
    for (int a = 0; a < 3; ++a) {
      selected.store(place_[a] + to, c.place[a]);
      selected.store(speed_[a] + to, c.speed[a]);
      selected.store(inverse_[a] + to, c.inverse[a]);
      selected.store(cell_[a] + to, cell[a]);
    }
    selected.store(end_ + to, c.end);
    selected.store(ray_ + to, ray);
    selected.store(field_ + to, field);
  }

  [[gnu::always_inline]] void enqueue(int i, LeafQueue& to) {
    const auto at = [&](int a) { return to_words(load<VFloat>(cell_[a] + i)); };
    const auto cells_along = [&](int a) { return static_cast<std::uint32_t>(g_.n[a]); };
    const Words<VFloat> cell = at(0) + cells_along(0) * (at(1) + cells_along(1) * at(2));
    const VFloat distance = bytes_at(g_.distance, load_words<VFloat>(field_ + i) + cell);
    store(distance_ + i, distance);
    const CompressMask full(bits(distance == VFloat(0)) & walking(i));
    full.store(to.ray + to.count, load_words<VFloat>(ray_ + i));
    full.store(to.cell + to.count, cell);
    to.count += full.count();
  }

  /// Bits of the lanes from i on that are under way.
  unsigned walking(int i) const {
    return bits(load<VFloat>(end_ + i) > VFloat(-kInfinity)) & active_before(i);
  }
  unsigned active_before(int i) const {
    const int left = count_ - i;
    return left >= kWidth<VFloat> ? ~0u : (1u << left) - 1u;
  }

  [[gnu::always_inline]] DdaState<VFloat> state(int i) const {
    DdaState<VFloat> c;
    for (int a = 0; a < 3; ++a) {
      c.place[a] = load<VFloat>(place_[a] + i);
      c.speed[a] = load<VFloat>(speed_[a] + i);
      c.inverse[a] = load<VFloat>(inverse_[a] + i);
    }
    c.end = load<VFloat>(end_ + i);
    return c;
  }

  [[gnu::always_inline]] void step(int i) {
    VFloat at[3];
    for (int a = 0; a < 3; ++a)
      at[a] = load<VFloat>(cell_[a] + i);
    const VFloat best = floats_at(p_.best, load_words<VFloat>(ray_ + i));
    const DdaState<VFloat> c = state(i);
    const Mask<VFloat> goes =
        grelha::GRELHA_ISA::step(g_, c, load<VFloat>(distance_ + i), best, at);
    for (int a = 0; a < 3; ++a)
      store(cell_[a] + i, select(goes, at[a], VFloat(0)));
    // only a ray that is under way has an end
    store(end_ + i, select(goes, c.end, VFloat(-kInfinity)));
    going_ += __builtin_popcount(bits(goes) & active_before(i));
  }

  void close_ranks() {
    int to = 0;
    for (int i = 0; i < count_; i += kWidth<VFloat>) {
      const CompressMask selected(walking(i));
      VFloat cell[3];
      for (int a = 0; a < 3; ++a)
        cell[a] = load<VFloat>(cell_[a] + i);
      const Words<VFloat> ray = load_words<VFloat>(ray_ + i);
      put(selected, to, state(i), cell, ray, load_words<VFloat>(field_ + i));
      to += selected.count();
    }
    count_ = to;
  }

  /// Makes lanes behind the last ray fit to be computed with; later such lanes hold old rays.
  void fill_up() {
    const int end = count_ + kWidth<VFloat>;
    for (int i = count_; i < end; ++i) {
      for (int a = 0; a < 3; ++a)
        cell_[a][i] = 0;
      end_[i] = -kInfinity;
      ray_[i] = 0;
      field_[i] = 0;
    }
  }

  const GridView& g_;
  const Packet& p_;
  int count_ = 0;
  int going_ = 0;
  alignas(64) float place_[3][kActiveRow];
  alignas(64) float speed_[3][kActiveRow];
  alignas(64) float inverse_[3][kActiveRow];
  alignas(64) float cell_[3][kActiveRow];
  alignas(64) float end_[kActiveRow];
  alignas(64) float distance_[kActiveRow];
  alignas(64) std::uint32_t ray_[kActiveRow];
  alignas(64) std::uint32_t field_[kActiveRow];
};

}  // namespace grelha::GRELHA_ISA
