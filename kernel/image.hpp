#pragma once

#include <cstddef>
#include <vector>

namespace grelha {

/// Linear RGB, three floats a pixel, row 0 on top.
struct Image {
  int width = 0, height = 0;
  std::vector<float> rgb;  ///< [height * width * 3]

  Image() = default;
  /// A black one.
  Image(int w, int h) : width(w), height(h), rgb(std::size_t(w) * std::size_t(h) * 3) {}
  /// Where row y begins.
  float* row(int y) { return rgb.data() + std::size_t(y) * std::size_t(width) * 3; }
  /// The same, to read.
  const float* row(int y) const { return rgb.data() + std::size_t(y) * std::size_t(width) * 3; }
};

}  // namespace grelha
