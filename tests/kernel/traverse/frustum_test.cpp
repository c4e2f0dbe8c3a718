// Tests that the frustum around a packet contains all of its rays, for any grid and any rays.
#include <cstdio>

#include "kernel/grid/grid.hpp"
#include "tests/lanes/lane_functions.hpp"
#include "tests/support/rays.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

/// A grid with nothing in it: up to 1024 cells an axis, of any size, up to a thousand grids from 0.
Grid random_grid(Random& random) {
  Grid g;
  const double edge = random.log_in(1e-4, 1e4);
  double extent = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    g.cells[a] = static_cast<std::uint32_t>(random.log_in(1, 1024.9));
    g.cell[a] = edge * random.in(.7, 1.4);
    extent = std::max(extent, g.cell[a] * g.cells[a]);
  }
  double squares = 0;
  for (std::size_t a = 0; a < 3; ++a)
    squares += g.cell[a] * g.cells[a] * g.cell[a] * g.cells[a];
  g.pad = 256 * 0x1p-24 * std::sqrt(squares);
  const double away = random.chance(.5) ? 0 : extent * random.log_in(.1, 1e3);
  for (double& lo : g.lo)
    lo = static_cast<float>(random.in(-1, 1) * away);
  return g;
}

/// Neighbours through a grid: from one eye, from many, or from within; along borders of cells; some
/// that only touch its far side.
class Bundle {
 public:
  Bundle(Random& random, const Grid& g, int count) : g_(g), random_(random) {
    const int kind = static_cast<int>(random.below(5));
    const Float3 eye = kind == 0 ? in_grid(.5) : outside();
    const double spread = random.log_in(1e-4, .3);
    const Float3 aim = in_grid(1);
    for (int i = 0; i < count; ++i) {
      Float3 org = kind == 2 ? near(eye, spread) : eye;
      Float3 to = near(aim, spread);
      if (kind == 3)
        to = on_border(to);
      Float3 dir = minus(to, org);
      if (kind == 4)
        org = touching(org, dir);
      rays.add(org, dir, random.chance(.3) ? static_cast<float>(random.log_in(1e-3, 1.2)) : 0.f);
    }
  }
  RayList rays;

 private:
  Float3 in_grid(double share) {
    Float3 p;
    for (std::uint32_t a = 0; a < 3; ++a)
      component(p, a) = static_cast<float>(g_.lo[a] + g_.cell[a] * g_.cells[a] *
                                                          (.5 + share * random_.in(-.5, .5)));
    return p;
  }
  double diagonal() const {
    double sum = 0;
    for (std::size_t a = 0; a < 3; ++a)
      sum += g_.cell[a] * g_.cells[a] * g_.cell[a] * g_.cells[a];
    return std::sqrt(sum);
  }
  Float3 outside() { return at(in_grid(1), diagonal() * random_.in(.5, 1.5), random_.direction()); }
  Float3 near(const Float3& p, double share) { return at(p, diagonal() * share, random_.point(1)); }
  Float3 on_border(Float3 p) {
    const std::uint32_t a = random_.below(3);
    const double cell = std::floor((component(p, a) - g_.lo[a]) / g_.cell[a]);
    component(p, a) = static_cast<float>(g_.lo[a] + g_.cell[a] * cell);
    return p;
  }
  /// From the side of the grid where a ray along dir leaves it: its way there has no length.
  Float3 touching(Float3 p, const Float3& dir) {
    Float3 d = dir;
    p = in_grid(1);
    std::uint32_t k = 0;
    for (std::uint32_t a = 1; a < 3; ++a)
      if (std::abs(component(d, a)) / g_.cell[a] > std::abs(component(d, k)) / g_.cell[k])
        k = a;
    const GridView view = g_.view();
    component(p, k) = component(d, k) > 0 ? view.hi_f[k] : view.lo_f[k];
    return p;
  }

  const Grid& g_;
  Random& random_;
};

struct Promise {
  const char* what;
  double FrustumCheck::*excess;
};
constexpr Promise kPromises[] = {{"sides", &FrustumCheck::sides},
                                 {"planes", &FrustumCheck::planes},
                                 {"planes, by balls", &FrustumCheck::balls},
                                 {"planes of a group", &FrustumCheck::group_planes},
                                 {"the near plane", &FrustumCheck::near},
                                 {"a group's near plane", &FrustumCheck::group_near},
                                 {"a plane's gradient", &FrustumCheck::gradient_length}};

class Frusta : public EveryVariant {};
GRELHA_FOR_EVERY_ISA(Frusta);

TEST_P(Frusta, HoldTheirRays) {
  const LaneFunctions& lanes = lane_functions(variant());
  int together = 0;
  for (std::uint64_t seed = 0; seed < 4000; ++seed) {
    Random random(seed);
    const Grid g = random_grid(random);
    const int count = random.chance(.5) ? lanes.most_rays : 1 + static_cast<int>(random.below(64));
    const RayList r = Bundle(random, g, count).rays;
    const FrustumCheck c = lanes.check_frustum(g.view(), r.view());
    if (!c.together)
      continue;
    ++together;
    const Promise* broken = nullptr;
    for (const Promise& promise : kPromises)
      if (!(c.*promise.excess <= 0))
        broken = &promise;
    ASSERT_EQ(broken, nullptr) << broken->what << " passed by " << c.*broken->excess << ", seed "
                               << seed << ", " << count << " rays";
    // rays go sideways by no more than 17/3 of their way along, and cells are at most twice as long
    // as wide
    ASSERT_LE(c.steepest, 2 * 17. / 3 * 1.001) << "seed " << seed;
  }
  EXPECT_GT(together, 1000);
}

}  // namespace
}  // namespace grelha::test
