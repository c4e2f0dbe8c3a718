#pragma once
// How rays go from cell to cell of a grid: the rule for many rays side by side, one a lane, and for
// one ray. Plane distances come from the plane's index, never by adding up.

#include "kernel/traverse/packet.hpp"

namespace grelha::GRELHA_ISA {

/// The cell, 0 to n - 1, of a coordinate in cells; 0 for NaN.
inline int clamp_cell(double x, int n) {
  if (!(x > 0))
    return 0;
  const int i = static_cast<int>(x < n ? x : n);
  return i < n ? i : n - 1;
}
/// The same, lane by lane.
template <class Real>
inline Real clamp_cells(const Real& x, int n) {
  return whole(min(max(x, Real(0)), Real(static_cast<float>(n - 1))));
}

/// Distances of cells for rays of one octant: to occupied cells ahead of the rays alone.
inline const std::uint8_t* distances_in(const GridView& g, unsigned octant) {
  return g.distance + (1 + std::size_t{octant}) * g.field_stride;
}

/// Rays in the units of one grid's cells.
template <class Real>
struct DdaState {
  Real origin_in_cells[3];  ///< position at t = 0
  Real speed[3];            ///< cells per unit of t
  Real inverse[3];          ///< of the speed
  Real end;                 ///< t where they leave the grid or their search

  /// t at which they cross a plane across an axis, in cells.
  [[gnu::always_inline]] Real t_at(int axis, const Real& plane) const {
    return (plane - origin_in_cells[axis]) * inverse[axis];
  }
  /// The cell along an axis at t, of n.
  [[gnu::always_inline]] Real cell_at(int axis, const Real& t, int n) const {
    return clamp_cells(origin_in_cells[axis] + t * speed[axis], n);
  }
};

/// The DDA state along one axis.
template <class Real>
[[gnu::always_inline]] inline void set_dda(
    const GridView& g, const Real (&org)[3], const Real (&dir)[3], int a, DdaState<Real>& c) {
  const Real least = min_advance(dir[0], dir[1], dir[2]);
  const Real cells(g.inv_cell_f[a]);
  c.origin_in_cells[a] = (org[a] - Real(g.lo_f[a])) * cells;
  c.speed[a] = with_advance(dir[a], least) * cells;
  c.inverse[a] = Real(1) / c.speed[a];
}

/// One ray in double, whose cells are those that the builder gives to points (cell_of in grid.hpp).
template <class Number>
inline DdaState<double> to_grid(const GridView& g, const Number (&org)[3], const float (&dir)[3]) {
  DdaState<double> c{};
  // less than what a float can be beside another: on its way from afar a ray strays by as much
  const double least = 1e-80 * static_cast<double>(max_abs(max_abs(dir[0], dir[1]), dir[2]));
  for (int a = 0; a < 3; ++a) {
    c.origin_in_cells[a] = (static_cast<double>(org[a]) - g.lo[a]) * g.inv_cell[a];
    c.speed[a] = with_advance(static_cast<double>(dir[a]), least) * g.inv_cell[a];
    c.inverse[a] = 1 / c.speed[a];
  }
  return c;
}

/// The part of [t0, t1] inside the box of all cells; empty when t0 > t1.
inline void clip_to_grid(const GridView& g, const DdaState<double>& c, double& t0, double& t1) {
  for (int a = 0; a < 3; ++a)
    clip_to_slab(0., double(g.n[a]), c.origin_in_cells[a], c.inverse[a], t0, t1);
}

/// The cells that rays from t = begin to t = best start in. Returns those that come to the grid.
template <class Real>
[[gnu::always_inline]] inline Mask<Real> enter(const GridView& g,
                                               const Real (&org)[3],
                                               const Real (&dir)[3],
                                               const Real& begin,
                                               const Real& best,
                                               DdaState<Real>& c,
                                               Real (&cell)[3]) {
  Real t0 = begin;
  Real t1 = best;
  const Mask<Real> search = best > begin;
  for (int a = 0; a < 3; ++a) {
    set_dda(g, org, dir, a, c);
    clip_to_slab(
        Real(0), Real(static_cast<float>(g.n[a])), c.origin_in_cells[a], c.inverse[a], t0, t1);
  }
  for (int a = 0; a < 3; ++a)
    cell[a] = c.cell_at(a, t0, g.n[a]);
  c.end = t1;
  return mask_and(search, t0 <= t1);
}

/// Which of three planes rays cross first, and at what t.
template <class Real>
struct FirstPlane {
  Mask<Real> axis[3];
  Real t;

  [[gnu::always_inline]] explicit FirstPlane(const Real (&at)[3]) {
    const Mask<Real> y = at[1] < at[0];
    t = select(y, at[1], at[0]);
    const Mask<Real> z = at[2] < t;
    t = select(z, at[2], t);
    axis[0] = and_not(t == t, mask_or(y, z));
    axis[1] = and_not(y, z);
    axis[2] = z;
  }
};

/// The next cells of rays whose cells are `distance` from the nearest before them that holds
/// something. Returns those that come there before they have hit anything.
template <class Real>
[[gnu::always_inline]] inline Mask<Real> step(const GridView& g,
                                              const DdaState<Real>& c,
                                              const Real& distance,
                                              const Real& best,
                                              Real (&cell)[3]) {
  // cells this far on are empty too
  const Real leap = max(distance - Real(1), Real(0));
  Real t[3], last[3], next[3];
  for (int a = 0; a < 3; ++a) {
    const Mask<Real> up = c.inverse[a] > Real(0);
    last[a] = select(up, cell[a] + leap, cell[a] - leap);
    next[a] = select(up, last[a] + Real(1), last[a] - Real(1));
    t[a] = c.t_at(a, select(up, next[a], next[a] + Real(1)));
  }
  const FirstPlane<Real> exit(t);
  Mask<Real> going = mask_and(best > exit.t, exit.t <= c.end);
  for (int a = 0; a < 3; ++a) {
    const Real at = c.cell_at(a, exit.t, g.n[a]);
    const Real side = min(max(at, min(cell[a], last[a])), max(cell[a], last[a]));
    cell[a] = select(exit.axis[a], next[a], side);
    const Real size(static_cast<float>(g.n[a]));
    going = mask_and(going, mask_and(cell[a] >= Real(0), cell[a] < size));
  }
  return going;
}

/// The cells of a grid that one ray comes through, by the same rule, for all axes at once. Which
/// plane comes next no processor foretells, so no branch depends on it.
class CellDda {
 public:
  explicit CellDda(const GridView& grid) : g_(grid) {}

  int cell() const { return cell_; }
  /// Distance from the ray's cell to the nearest cell ahead that holds something.
  int distance() const { return distance_[cell_]; }

  /// False: the ray does not come to the grid.
  [[gnu::always_inline]] bool start(const Single& r) {
    set_dda(r);
    const float begin = first_t(*r.t_min);
    end_ = last_t(*r.best);
    if (!(*r.best > *r.t_min) || !(begin <= end_))
      return false;
    const FourInts up = inverse_ > four(0);
    up_ = masked(up, four(1));
    step_ = (up_ + up_) - four(1);
    last_cell_ = masked(up, last_);
    signed_strides_ = up ? strides_ : FourInts{} - strides_;
    distance_ = distances_in(g_, bits(inverse_ < four(0)));
    go_to(cell_at(four(begin)));
    return true;
  }

  /// Goes on to the next cell. False: there is none before t = best.
  [[gnu::always_inline]] bool step(float best) {
    const FourInts axis = first_axis(exit_);
    if (!any(axis & (at_ != last_cell_) & goes_on(exit_, best)))
      return false;
    at_ = at_ + masked(axis, step_);
    cell_ += sum(signed_strides_ & axis);
    exit_ = axis ? exit_after_ : exit_;
    exit_after_ = far_side(at_ + step_);
    return true;
  }

  /// The same over cells that are empty, as are those within `by` of this one on its way.
  [[gnu::always_inline]] bool leap(int by, float best) {
    const Four far = four(static_cast<float>(by));
    const Four exit = far_side(at_ + step_ * far);
    const FourInts axis = first_axis(exit);
    if (!any(axis & ((last_cell_ - at_) * step_ > far) & goes_on(exit, best)))
      return false;
    const FourInts at = to_ints(at_);
    const FourInts last = at + to_ints(step_) * by;
    const FourInts next = last + to_ints(step_);
    const FourInts side = cell_at(of_axis(axis, exit));
    go_to(axis ? next : min(max(side, min(at, last)), max(at, last)));
    return true;
  }

 private:
  static constexpr float kNever = __builtin_inff();

  /// As the free function does. The fourth lane stays where it is: its planes are never crossed.
  [[gnu::always_inline]] void set_dda(const Single& r) {
    const Four dir = four(r.dir, 0);
    const Four least = four(min_advance(*r.dir[0], *r.dir[1], *r.dir[2]));
    const Four cells = four(g_.inv_cell_f, 1);
    const FourInts n{g_.n[0], g_.n[1], g_.n[2], 1};
    place_ = (four(r.org, 0) - four(g_.lo_f, 0)) * cells;
    speed_ = with_advance(dir, least) * cells;
    inverse_ = four(1) / speed_;
    inverse_[3] = kNever;
    last_ = to_floats(n) - four(1);
    strides_ = FourInts{1, n[0], n[0] * n[1], 0};
  }
  /// t of the planes around all cells, lesser and greater.
  Four first_planes() const { return (four(0) - place_) * inverse_; }
  Four last_planes() const { return ((last_ + four(1)) - place_) * inverse_; }
  float first_t(float t_min) const {
    Four t = min(first_planes(), last_planes());
    t[3] = t_min;
    return reduce_max(max(t, four(t_min)));
  }
  float last_t(float best) const {
    Four t = max(first_planes(), last_planes());
    t[3] = best;
    return reduce_min(min(t, four(best)));
  }

  /// Mask of the plane that is crossed next; of several at once, the plane of the first axis. Empty
  /// if one is NaN.
  static FourInts first_axis(const Four& exit) {
    const Four after = __builtin_shufflevector(exit, exit, 1, 2, 0, 3);
    const Four before = __builtin_shufflevector(exit, exit, 2, 0, 1, 3);
    const FourInts wins_ties_after{-1, -1, 0, 0};
    const FourInts wins_ties_before{-1, 0, 0, 0};
    return ((exit < after) | ((exit <= after) & wins_ties_after)) &
           ((exit < before) | ((exit <= before) & wins_ties_before));
  }
  static Four of_axis(const FourInts& axis, const Four& exit) {
    return reinterpret_cast<Four>(any_of(reinterpret_cast<FourInts>(masked(axis, exit))));
  }
  FourInts goes_on(const Four& exit, float best) const {
    return (four(best) > exit) & (exit <= four(end_));
  }
  /// t at the far side of a cell.
  Four far_side(const Four& at) const { return ((at + up_) - place_) * inverse_; }
  /// The cell at t, clamped to the grid.
  FourInts cell_at(const Four& t) const {
    return to_ints(min(max(place_ + t * speed_, four(0)), last_));
  }
  void go_to(const FourInts& at) {
    cell_ = sum(at * strides_);
    at_ = to_floats(at);
    exit_ = far_side(at_);
    exit_after_ = far_side(at_ + step_);
  }

  const GridView& g_;
  Four place_, speed_, inverse_;  ///< as of DdaState
  float end_;                     ///< the same
  Four last_;                     ///< the last cell of all
  Four up_;                       ///< 1 along axes on which the ray goes up, else 0
  Four step_;                     ///< 1 or -1
  Four last_cell_;                ///< the last cell along its way
  Four at_;                       ///< the cell it is in
  Four exit_;                     ///< t of the plane that it crosses next on each axis
  Four exit_after_;               ///< the same of the plane after that
  FourInts strides_, signed_strides_;
  const std::uint8_t* distance_;  ///< of cells, for its octant
  int cell_;
};

}  // namespace grelha::GRELHA_ISA
