// The sphereflake: every ball carries nine of a third its radius.
#include <array>
#include <cmath>

#include "scenes/generators.hpp"
#include "scenes/nff_writer.hpp"

namespace grelha::scenes {

namespace {

/// Returns the directions from a ball that points along +z to its nine children: six around the
/// equator, three above.
std::array<Vec, 9> child_directions() {
  const double s = std::sqrt(0.5);
  const std::array<Vec, 3> flat{Vec{s, s, 0}, Vec{s, 0, -s}, Vec{0, s, -s}};
  const double tilt = std::asin(2 / std::sqrt(6.0));
  std::array<Vec, 9> directions;
  for (int third = 0; third < 3; ++third)
    for (int i = 0; i < 3; ++i)
      directions[std::size_t(3 * third + i)] =
          turn(turn(flat[std::size_t(i)], {s, -s, 0}, tilt), {0, 0, 1}, degrees(120.0 * third));
  return directions;
}

/// `v`, given in the frame whose +z is `axis`, seen from outside.
Vec from_frame(Vec v, Vec axis) {
  // SPD's thresholds: beyond them z x axis is rounding noise, and older builds did turn about that
  // noise.
  if (axis.z >= 0.9999)
    return v;
  if (axis.z <= -0.9999)
    return turn(v, {0, 1, 0}, kPi);
  return turn(v, normalise(cross({0, 0, 1}, axis)), std::acos(axis.z));
}

class Flake {
 public:
  explicit Flake(NffWriter& nff) : nff_(nff) {}

  void write(Vec center, double radius, Vec axis, int depth) {
    nff_.sphere(center, radius);
    if (depth == 0)
      return;
    for (const Vec& child : children_) {
      const Vec out = from_frame(child, axis);
      write(center + 4.0 / 3.0 * radius * out, radius / 3, out, depth - 1);
    }
  }

 private:
  NffWriter& nff_;
  const std::array<Vec, 9> children_ = child_directions();
};

void write_floor(NffWriter& nff, bool spd) {
  const Vec a{12, 12, -0.5}, b{-12, 12, -0.5}, c{-12, -12, -0.5}, d{12, -12, -0.5};
  if (spd)
    nff.polygon({a, b, c, d});
  else
    nff.plane(a, b, c);
}

}  // namespace

void write_balls(std::ostream& out, const SceneOptions& options) {
  NffWriter nff(out);
  nff.background({0.078, 0.361, 0.753});
  nff.view({.from = {2.1, 1.3, 1.7}, .at = {0, 0, 0}});
  for (const Vec& light : {Vec{4, 3, 2}, Vec{1, -4, 4}, Vec{-3, 1, 5}})
    if (options.spd)
      nff.light(light);
    else
      nff.light(light, {1, 1, 1});
  nff.surface({.color = {1, 0.75, 0.33}, .kd = 0.8, .shine = 100000, .ior = 1});
  write_floor(nff, options.spd);
  nff.surface({.color = {1, 0.9, 0.7}, .kd = 0.5, .ks = 0.5, .shine = 3.0827, .ior = 1});
  Flake(nff).write({0, 0, 0}, 0.5, {0, 0, 1}, options.size);
}

}  // namespace grelha::scenes
