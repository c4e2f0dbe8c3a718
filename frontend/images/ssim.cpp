#include "frontend/images/ssim.hpp"

#include <numeric>

#include "frontend/images/filters.hpp"

namespace grelha {
namespace {

constexpr int kWindowRadius = 5;
constexpr double kSigma = 1.5;
/// Constants that stabilize quotients of small numbers; white is 1.
constexpr double kC1 = .01 * .01, kC2 = .03 * .03;

/// Rows from `first` up to `end`.
Plane luma(const Image& image, int first, int end) {
  Plane plane(image.width, end - first);
  for (int y = first; y < end; ++y) {
    const float* rgb = image.row(y);
    for (int x = 0; x < image.width; ++x)
      plane.row(y - first)[x] = .299 * rgb[3 * x] + .587 * rgb[3 * x + 1] + .114 * rgb[3 * x + 2];
  }
  return plane;
}

Plane product(Plane a, const Plane& b) {
  for (std::size_t i = 0; i < a.values.size(); ++i)
    a.values[i] *= b.values[i];
  return a;
}

/// The weighted means of two pictures and of their products.
struct Windows {
  Windows(const Plane& x, const Plane& y, const Taps& taps)
      : mean_x(filtered(x, taps, taps)),
        mean_y(filtered(y, taps, taps)),
        xx(filtered(product(x, x), taps, taps)),
        yy(filtered(product(y, y), taps, taps)),
        xy(filtered(product(x, y), taps, taps)) {}

  double similarity(std::size_t i) const {
    const double mx = mean_x.values[i], my = mean_y.values[i];
    const double squares = mx * mx + my * my;
    const double variances = xx.values[i] + yy.values[i] - squares;
    const double covariance = xy.values[i] - mx * my;
    return (2 * mx * my + kC1) * (2 * covariance + kC2) / ((squares + kC1) * (variances + kC2));
  }

  Plane mean_x, mean_y, xx, yy, xy;
};

}  // namespace

std::optional<double> ssim(const Image& a, const Image& b) {
  const int columns = a.width - 2 * kWindowRadius, rows = a.height - 2 * kWindowRadius;
  if (columns < 1 || rows < 1)
    return {};
  const Taps taps = normalized(bell(kWindowRadius, kSigma));
  std::vector<double> sums(static_cast<std::size_t>(rows));
  each_strip(rows, [&](int first, int end) {
    const int last = end + 2 * kWindowRadius;
    const Windows windows(luma(a, first, last), luma(b, first, last), taps);
    for (std::size_t i = 0; i < windows.xy.values.size(); ++i)
      sums[std::size_t(first) + i / std::size_t(columns)] += windows.similarity(i);
  });
  return std::accumulate(sums.begin(), sums.end(), 0.) / (double(rows) * columns);
}

}  // namespace grelha
