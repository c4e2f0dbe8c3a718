#pragma once
// How rays go from cell to cell of a grid: the rule for many rays side by side, one a lane, and for
// one ray. Plane distances come from the plane's index, never by adding up.

#include "kernel/walk/single.hpp"

namespace grelha::GRELHA_ISA {

/// clamp_cell, lane by lane: 0 for NaN.
template <class Real>
inline Real clamp_cells(const Real& x, int n) {
  return whole(lesser(greater(x, Real(0)), Real(static_cast<float>(n - 1))));
}

/// Rays in the units of one grid's cells.
template <class Real>
struct Course {
  Real place[3];    ///< at t = 0
  Real speed[3];    ///< what they make in one t
  Real inverse[3];  ///< of the speed
  Real end;         ///< t where they leave the grid or their search

  /// t at which they meet a plane across an axis, in cells.
  [[gnu::always_inline]] Real t_at(int axis, const Real& plane) const {
    return (plane - place[axis]) * inverse[axis];
  }
  /// The cell along an axis at t, of n.
  [[gnu::always_inline]] Real cell_at(int axis, const Real& t, int n) const {
    return clamp_cells(place[axis] + t * speed[axis], n);
  }
};

/// The course along one axis.
template <class Real>
[[gnu::always_inline]] inline void set_course(
    const GridView& g, const Real (&org)[3], const Real (&dir)[3], int a, Course<Real>& c) {
  const Real least = least_headway(dir[0], dir[1], dir[2]);
  const Real cells(g.inv_cell_f[a]);
  c.place[a] = (org[a] - Real(g.lo_f[a])) * cells;
  const Real tiny = select(dir[a] < Real(0), Real(0) - least, least);
  c.speed[a] = select(magnitude(dir[a]) < least, tiny, dir[a]) * cells;
  c.inverse[a] = Real(1) / c.speed[a];
}

/// The cells that rays from t = begin to t = best start in. Returns those that come to the grid.
template <class Real>
[[gnu::always_inline]] inline Mask<Real> enter(const GridView& g,
                                               const Real (&org)[3],
                                               const Real (&dir)[3],
                                               const Real& begin,
                                               const Real& best,
                                               Course<Real>& c,
                                               Real (&cell)[3]) {
  Real t0 = begin;
  Real t1 = best;
  const Mask<Real> search = best > begin;
  for (int a = 0; a < 3; ++a) {
    set_course(g, org, dir, a, c);
    const Real size(static_cast<float>(g.n[a]));
    const Real x = c.t_at(a, Real(0));
    const Real y = c.t_at(a, size);
    t0 = greater(lesser(x, y), t0);
    t1 = lesser(greater(x, y), t1);
  }
  for (int a = 0; a < 3; ++a)
    cell[a] = c.cell_at(a, t0, g.n[a]);
  c.end = t1;
  return both(search, t0 <= t1);
}

/// Which of three planes rays meet first, and at what t.
template <class Real>
struct FirstPlane {
  Mask<Real> axis[3];
  Real t;

  [[gnu::always_inline]] explicit FirstPlane(const Real (&at)[3]) {
    const Mask<Real> y = at[1] < at[0];
    t = select(y, at[1], at[0]);
    const Mask<Real> z = at[2] < t;
    t = select(z, at[2], t);
    axis[0] = but_not(t == t, either(y, z));
    axis[1] = but_not(y, z);
    axis[2] = z;
  }
};

/// The next cells of rays whose cells are `distance` from the nearest that holds something. Returns
/// those that come there before they have met anything.
template <class Real>
[[gnu::always_inline]] inline Mask<Real> step(const GridView& g,
                                              const Course<Real>& c,
                                              const Real& distance,
                                              const Real& best,
                                              Real (&cell)[3]) {
  // cells this far on each side are empty too
  const Real leap = greater(distance - Real(1), Real(0));
  Real t[3], next[3];
  for (int a = 0; a < 3; ++a) {
    const Mask<Real> up = c.inverse[a] > Real(0);
    next[a] = select(up, cell[a] + leap + Real(1), cell[a] - leap - Real(1));
    t[a] = c.t_at(a, select(up, next[a], next[a] + Real(1)));
  }
  const FirstPlane<Real> exit(t);
  Mask<Real> going = both(best > exit.t, exit.t <= c.end);
  for (int a = 0; a < 3; ++a) {
    const Real at = c.cell_at(a, exit.t, g.n[a]);
    const Real side = lesser(greater(at, cell[a] - leap), cell[a] + leap);
    cell[a] = select(exit.axis[a], next[a], side);
    const Real size(static_cast<float>(g.n[a]));
    going = both(going, both(cell[a] >= Real(0), cell[a] < size));
  }
  return going;
}

/// The cells of a grid that one ray comes through, by the same rule. Where it goes to the next
/// cell, one coordinate changes and one plane: a prediction of which one is all that the next cell
/// waits for.
class CellWalk {
 public:
  explicit CellWalk(const GridView& grid) : g_(grid) {}

  int cell() const { return cell_; }

  /// False: the ray does not come to the grid.
  [[gnu::always_inline]] bool start(const WalkingRay& r) {
    float first[3];
    if (!enter<float>(g_, r.org, r.dir, r.t_min, r.best, c_, first))
      return false;
    stride_[0] = 1;
    stride_[1] = g_.n[0];
    stride_[2] = g_.n[0] * g_.n[1];
    cell_ = 0;
    for (int a = 0; a < 3; ++a) {
      up_[a] = c_.inverse[a] > 0;
      set(a, static_cast<int>(first[a]));
      cell_ += at_[a] * stride_[a];
    }
    return true;
  }

  /// Goes on to the next cell. False: there is none before t = best.
  bool step(float best) {
    const int axis = first_axis();
    const int next = up_[axis] ? at_[axis] + 1 : at_[axis] - 1;
    if (!goes_on(axis, next, best))
      return false;
    cell_ += up_[axis] ? stride_[axis] : -stride_[axis];
    set(axis, next);
    return true;
  }

  /// The same over cells that are empty, as are those within `by` of this one on each side.
  bool leap(int by, float best) {
    for (int a = 0; a < 3; ++a)
      exit_[a] = far_side(a, at_[a] + (up_[a] ? by : -by));
    const int axis = first_axis();
    const int next = up_[axis] ? at_[axis] + by + 1 : at_[axis] - by - 1;
    if (!goes_on(axis, next, best))
      return false;
    const float t = exit_[axis];
    for (int a = 0; a < 3; ++a)
      set(a, a == axis ? next : beside(a, by, t));
    cell_ = at_[0] + stride_[1] * at_[1] + stride_[2] * at_[2];
    return true;
  }

 private:
  /// Of the planes that are met next.
  int first_axis() const {
    if (exit_[1] < exit_[0])
      return exit_[2] < exit_[1] ? 2 : 1;
    return exit_[2] < exit_[0] ? 2 : 0;
  }
  bool goes_on(int axis, int next, float best) const {
    return best > exit_[axis] && exit_[axis] <= c_.end &&
           static_cast<unsigned>(next) < static_cast<unsigned>(g_.n[axis]);
  }
  /// The cell at t along an axis, at most `by` from this one.
  int beside(int a, int by, float t) const {
    const int side = static_cast<int>(c_.cell_at(a, t, g_.n[a]));
    const int least = at_[a] - by;
    const int most = at_[a] + by;
    return side < least ? least : side > most ? most : side;
  }
  /// t at the far side of a cell.
  float far_side(int a, int i) const { return c_.t_at(a, static_cast<float>(i + up_[a])); }
  void set(int a, int i) {
    at_[a] = i;
    exit_[a] = far_side(a, i);
  }

  const GridView& g_;
  Course<float> c_;
  int stride_[3];
  int at_[3];
  int up_[3];      ///< 1 along axes on which it goes up, else 0
  float exit_[3];  ///< t of the plane that it meets next on each axis
  int cell_;
};

}  // namespace grelha::GRELHA_ISA
