#include "frontend/images/flip.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "frontend/images/filters.hpp"
#include "frontend/images/tone.hpp"

namespace grelha {
namespace {

/// A screen .7 m and 3840 pixels wide, seen from .7 m.
constexpr double kPixelsPerDegree = .7 * (3840 / .7) * std::numbers::pi / 180;
constexpr int kRadius = 10;  ///< of colours: three sigmas of the widest, rounded up

using Triple = std::array<double, 3>;
using Matrix = std::array<Triple, 3>;

constexpr Triple operator*(const Matrix& m, const Triple& v) {
  Triple product{};
  for (std::size_t i = 0; i < 3; ++i)
    product[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
  return product;
}

constexpr Matrix inverse(const Matrix& m) {
  Matrix cofactors{}, result{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Triple &p = m[(i + 1) % 3], &q = m[(i + 2) % 3];
    cofactors[i] = {
        p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
  }
  const Triple& c = cofactors[0];
  const double determinant = m[0][0] * c[0] + m[0][1] * c[1] + m[0][2] * c[2];
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      result[i][j] = cofactors[j][i] / determinant;
  return result;
}

/// CIE XYZ of light in the primaries of sRGB, over that of white.
constexpr Matrix kXyz = [] {
  Matrix m{{{10135552. / 24577794, 8788810. / 24577794, 4435075. / 24577794},
            {2613072. / 12288897, 8788810. / 12288897, 887015. / 12288897},
            {1425312. / 73733382, 8788810. / 73733382, 70074185. / 73733382}}};
  for (Triple& row : m) {
    const double white = row[0] + row[1] + row[2];
    for (double& v : row)
      v /= white;
  }
  return m;
}();
constexpr Matrix kRgb = inverse(kXyz);

/// L*a*b* of light, a and b times L / 100: colours fade in the dark (Hunt).
Triple lab(const Triple& rgb) {
  constexpr double kDelta = 6. / 29;
  Triple f = kXyz * rgb;
  for (double& v : f)
    v = v > kDelta * kDelta * kDelta ? std::cbrt(v) : v / (3 * kDelta * kDelta) + 4. / 29;
  const double l = 116 * f[1] - 16;
  return {l, .01 * l * 500 * (f[0] - f[1]), .01 * l * 200 * (f[1] - f[2])};
}

/// The distance HyAB of colours, to the power .7.
double hyab(const Triple& a, const Triple& b) {
  const double da = a[1] - b[1], db = a[2] - b[2];
  return std::pow(std::abs(a[0] - b[0]) + std::sqrt(da * da + db * db), .7);
}

/// From 0 to 1: of distances up to .4 of the largest, which is that of green and blue, the share
/// from 0 to .95.
double color_error(double distance) {
  static const double largest = hyab(lab({0, 1, 0}), lab({0, 0, 1}));
  const double knee = .4 * largest;
  return distance < knee ? .95 / knee * distance : .95 + .05 * (distance - knee) / (largest - knee);
}

/// Scales the positive weights to a sum of 1, and the negative ones to a sum of -1.
Taps balanced(Taps taps) {
  double positive = 0, negative = 0;
  for (const double weight : taps)
    (weight > 0 ? positive : negative) += std::abs(weight);
  for (double& weight : taps)
    weight /= weight > 0 ? positive : negative;
  return taps;
}

/// Pads taps with zeros on both sides, to as many as the colour filters have.
Taps widened(const Taps& taps) {
  Taps wide(2 * kRadius + 1);
  std::ranges::copy(taps, wide.begin() + std::ptrdiff_t(wide.size() - taps.size()) / 2);
  return wide;
}

/// The filters of human vision at that distance.
struct Eye {
  /// The Gaussians of contrast sensitivity: light and dark, red and green, blue and yellow. The
  /// last is a sum of two, in which the narrow one has the share `narrow`.
  Taps light, red_green, blue_yellow, blue_yellow_narrow;
  double narrow;
  /// A Gaussian across an edge or a point, and its first and second derivative along.
  Taps across, edge, point;
};

Eye make_eye() {
  const auto contrast = [](double b) {
    return bell(kRadius, kPixelsPerDegree * std::sqrt(b / 2) / std::numbers::pi);
  };
  const auto volume = [](double a, double b, const Taps& taps) {
    return a * std::sqrt(std::numbers::pi / b) * sum(taps) * sum(taps);
  };
  Eye eye{contrast(.0047), contrast(.0053), contrast(.04), contrast(.025), 0, {}, {}, {}};
  const double wide = volume(34.1, .04, eye.blue_yellow),
               narrow = volume(13.5, .025, eye.blue_yellow_narrow);
  eye.narrow = narrow / (wide + narrow);
  for (Taps* taps : {&eye.light, &eye.red_green, &eye.blue_yellow, &eye.blue_yellow_narrow})
    *taps = normalized(std::move(*taps));

  const double sigma = .5 * .082 * kPixelsPerDegree;
  const int radius = int(std::ceil(3 * sigma));
  eye.across = eye.edge = eye.point = bell(radius, sigma);
  for (int x = -radius; x <= radius; ++x) {
    eye.edge[std::size_t(x + radius)] *= -x;
    eye.point[std::size_t(x + radius)] *= x * x / (sigma * sigma) - 1;
  }
  eye.across = widened(normalized(std::move(eye.across)));
  eye.edge = widened(balanced(std::move(eye.edge)));
  eye.point = widened(balanced(std::move(eye.point)));
  return eye;
}

/// Y, X - Y and Y - Z, relative to white: YCxCz without its constant factors, because the filters
/// are linear.
using Opponents = std::array<Plane, 3>;

/// Rows from `first` up to `end` and kRadius pixels around them; beyond the picture the nearest of
/// its own.
Opponents opponents(const Image& image, int first, int end) {
  const Plane empty(image.width + 2 * kRadius, end - first + 2 * kRadius);
  Opponents planes{empty, empty, empty};
  for (int y = 0; y < empty.height; ++y) {
    const float* from = image.row(std::clamp(first - kRadius + y, 0, image.height - 1));
    std::array<double*, 3> to{planes[0].row(y), planes[1].row(y), planes[2].row(y)};
    for (int x = 0; x < image.width; ++x, from += 3) {
      const Triple xyz =
          kXyz * Triple{light_of_srgb(from[0]), light_of_srgb(from[1]), light_of_srgb(from[2])};
      to[0][kRadius + x] = xyz[1];
      to[1][kRadius + x] = xyz[0] - xyz[1];
      to[2][kRadius + x] = xyz[1] - xyz[2];
    }
    for (double* row : to) {
      std::fill_n(row, kRadius, row[kRadius]);
      std::fill_n(row + kRadius + image.width, kRadius, row[kRadius + image.width - 1]);
    }
  }
  return planes;
}

/// How strongly each pixel is an edge, or a point.
Plane feature(const Plane& y, const Taps& dot_of, const Taps& across) {
  Plane strength = filtered(y, dot_of, across);
  const Plane other = filtered(y, across, dot_of);
  for (std::size_t i = 0; i < strength.values.size(); ++i)
    strength.values[i] = std::hypot(strength.values[i], other.values[i]);
  return strength;
}

Plane mixed(Plane a, const Plane& b, double share_of_b) {
  for (std::size_t i = 0; i < a.values.size(); ++i)
    a.values[i] += share_of_b * (b.values[i] - a.values[i]);
  return a;
}

/// Rows of a picture as an eye sees them.
class Seen {
 public:
  Seen(const Eye& eye, const Opponents& from)
      : y_(filtered(from[0], eye.light, eye.light)),
        x_less_y_(filtered(from[1], eye.red_green, eye.red_green)),
        y_less_z_(mixed(filtered(from[2], eye.blue_yellow, eye.blue_yellow),
                        filtered(from[2], eye.blue_yellow_narrow, eye.blue_yellow_narrow),
                        eye.narrow)),
        edge_(feature(from[0], eye.edge, eye.across)),
        point_(feature(from[0], eye.point, eye.across)) {}

  /// FLIP of pixel i.
  friend double error_at(const Seen& a, const Seen& b, std::size_t i) {
    const double colours = color_error(hyab(a.colour(i), b.colour(i)));
    const double features = std::max(std::abs(a.edge_.values[i] - b.edge_.values[i]),
                                     std::abs(a.point_.values[i] - b.point_.values[i]));
    return std::pow(colours, 1 - std::sqrt(features / std::numbers::sqrt2));
  }

 private:
  Triple colour(std::size_t i) const {
    const double y = y_.values[i];
    Triple rgb = kRgb * Triple{y + x_less_y_.values[i], y, y - y_less_z_.values[i]};
    for (double& v : rgb)
      v = std::clamp(v, 0., 1.);
    return lab(rgb);
  }

  Plane y_, x_less_y_, y_less_z_, edge_, point_;
};

}  // namespace

std::vector<float> flip(const Image& a, const Image& b) {
  const Eye eye = make_eye();
  std::vector<float> map(std::size_t(a.width) * std::size_t(a.height));
  each_strip(a.height, [&](int first, int end) {
    const Seen seen_a(eye, opponents(a, first, end)), seen_b(eye, opponents(b, first, end));
    float* to = map.data() + std::size_t(first) * std::size_t(a.width);
    const std::size_t count = std::size_t(end - first) * std::size_t(a.width);
    for (std::size_t i = 0; i < count; ++i)
      to[i] = float(error_at(seen_a, seen_b, i));
  });
  return map;
}

}  // namespace grelha
