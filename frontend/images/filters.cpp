#include "frontend/images/filters.hpp"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kernel/base/parallel_for.hpp"

namespace grelha {
namespace {

/// Rows that are filtered at a time; the rows around them are read again for the next strip.
constexpr int kStrip = 64;

void add(double* to, const double* from, double weight, int count) {
  for (int i = 0; i < count; ++i)
    to[i] += weight * from[i];
}

}  // namespace

Taps bell(int radius, double sigma) {
  Taps taps;
  for (int x = -radius; x <= radius; ++x)
    taps.push_back(std::exp(-double(x) * x / (2 * sigma * sigma)));
  return taps;
}

double sum(const Taps& taps) {
  return std::accumulate(taps.begin(), taps.end(), 0.);
}

Taps normalized(Taps taps) {
  const double whole = sum(taps);
  for (double& weight : taps)
    weight /= whole;
  return taps;
}

Plane filtered(const Plane& plane, const Taps& across, const Taps& down) {
  const int lost = int(across.size()) - 1;
  Plane rows(plane.width - lost, plane.height);
  for (int y = 0; y < rows.height; ++y)
    for (int i = 0; i <= lost; ++i)
      add(rows.row(y), plane.row(y) + i, across[std::size_t(i)], rows.width);
  Plane both(rows.width, rows.height - lost);
  for (int y = 0; y < both.height; ++y)
    for (int i = 0; i <= lost; ++i)
      add(both.row(y), rows.row(y + i), down[std::size_t(i)], both.width);
  return both;
}

void each_strip(int height, const std::function<void(int first, int end)>& work) {
  each_turn(
      std::size_t((height + kStrip - 1) / kStrip), omp_get_max_threads(), [&](std::size_t turn) {
        const int first = int(turn) * kStrip;
        work(first, std::min(first + kStrip, height));
      });
}

}  // namespace grelha
