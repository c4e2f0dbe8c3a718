// A tree: every branch is a cone with a ball on top and carries two smaller ones.
#include "scenes/generators.hpp"
#include "scenes/nff_writer.hpp"

namespace grelha::scenes {

namespace {

/// The coordinate frame of a branch: its foot, and its axes, which are as long as the branch.
struct Frame {
  Vec foot, x, y, z;
  Vec axes(Vec v) const { return v.x * x + v.y * y + v.z * z; }
};

struct Fork {
  double shrink, tilt_deg, turn_deg;
};
constexpr Fork kForks[] = {{0.65, 40, 90}, {0.70, 25, 230}};
constexpr double kTrunkRadius = 0.15, kTaper = 0.67;

/// A frame on top of `parent`, tilted about its own x axis first and then turned about z.
Frame grow(const Frame& parent, const Fork& fork) {
  const auto axis = [&](Vec v) {
    const Vec tilted = turn(v, {1, 0, 0}, degrees(fork.tilt_deg));
    return fork.shrink * parent.axes(turn(tilted, {0, 0, 1}, degrees(fork.turn_deg)));
  };
  return {parent.foot + parent.z, axis({1, 0, 0}), axis({0, 1, 0}), axis({0, 0, 1})};
}

void write_branch(NffWriter& nff, const Frame& frame, double radius, int depth) {
  const Vec top = frame.foot + frame.z;
  nff.cone(frame.foot, radius, top, kTaper * radius);
  nff.sphere(top, kTaper * radius);
  if (depth == 0)
    return;
  for (const Fork& fork : kForks)
    write_branch(nff, grow(frame, fork), kTaper * radius, depth - 1);
}

}  // namespace

void write_tree(std::ostream& out, const SceneOptions& options) {
  NffWriter nff(out);
  nff.background({0.078, 0.361, 0.753});
  nff.view({.from = {4.5, 0.4, 2}, .at = {0, 0, 1.5}, .hither = 1});
  for (const Vec& light : {Vec{-5, 5, 50},
                           Vec{30, -30, 30},
                           Vec{-40, -30, 20},
                           Vec{10, 30, 40},
                           Vec{-30, 40, 10},
                           Vec{50, 25, 20},
                           Vec{-10, -60, 30}})
    nff.light(light);
  nff.surface({.color = {0.2, 0.7, 0.2}, .kd = 1, .shine = 100000});
  nff.polygon({{50, 50, 0}, {-50, 50, 0}, {-50, -50, 0}, {50, -50, 0}});
  nff.surface({.color = {0.55, 0.4, 0.2}, .kd = 1, .shine = 100000});
  write_branch(nff, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, kTrunkRadius, options.size);
}

}  // namespace grelha::scenes
