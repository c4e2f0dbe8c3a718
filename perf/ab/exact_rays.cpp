#include "perf/ab/exact_rays.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace grelha::perf {
namespace {

constexpr int kRays = 20000, kSteps = 16;  // 2^kSteps across
constexpr std::size_t kFewest = 100;
constexpr float kAround = 6;  ///< origins lie in a cube so many times as wide

struct Lattice {
  float low[3], high[3], width = 0, step;

  explicit Lattice(const Triangles& m) {
    const std::vector<float>* const axes[] = {&m.x, &m.y, &m.z};
    for (int a = 0; a < 3; ++a) {
      const auto [least, most] = std::minmax_element(axes[a]->begin(), axes[a]->end());
      low[a] = *least;
      high[a] = *most;
      width = std::max(width, high[a] - low[a]);
    }
    step = std::exp2(std::ceil(std::log2(width)) - kSteps);
  }
};

float to_multiple(float x, float step) {
  return step * std::round(x / step);
}

}  // namespace

void snap(Triangles& m) {
  if (m.size() == 0)
    return;
  const float step = Lattice(m).step;
  for (std::vector<float>* const axis : {&m.x, &m.y, &m.z})
    for (float& x : *axis)
      x = to_multiple(x, step);
}

RayBuffer exact_rays(const Triangles& m, bool at_edges) {
  RayBuffer rays;
  if (m.size() < kFewest)
    return rays;
  const Lattice lattice(m);
  const std::vector<float>* const axes[] = {&m.x, &m.y, &m.z};
  std::mt19937 bits{1};
  const auto random = [&] { return static_cast<float>(bits() >> 8) * 0x1p-24f; };
  for (int i = 0; i < kRays; ++i) {
    const std::size_t triangle = bits() % m.size(), a = m.a[triangle], b = m.b[triangle];
    float org[3], dir[3];
    for (int k = 0; k < 3; ++k) {
      const auto& x = *axes[k];
      const float to = at_edges ? .5f * (x[a] + x[b]) : x[a];
      const float middle = .5f * (lattice.low[k] + lattice.high[k]);
      // half a step: where middles of edges lie
      org[k] = to_multiple(middle + (random() - .5f) * kAround * lattice.width, .5f * lattice.step);
      dir[k] = to - org[k];
    }
    rays.add(org, dir, std::numeric_limits<float>::infinity());
  }
  return rays;
}

}  // namespace grelha::perf
