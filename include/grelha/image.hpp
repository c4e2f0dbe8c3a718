#pragma once

#include <cstdint>
#include <cstddef>
#include <vector>

namespace grelha {

/// Linear RGB, three floats a pixel, row 0 on top.
struct Image {
  int width = 0, height = 0;
  std::vector<float> rgb;  ///< [height * width * 3]

  Image() = default;
  /// A black image.
  Image(int w, int h) : width(w), height(h), rgb(std::size_t(w) * std::size_t(h) * 3) {}
  /// Returns a pointer to the first float of row y.
  float* row(int y) { return rgb.data() + std::size_t(y) * std::size_t(width) * 3; }
  /// The same, read-only.
  const float* row(int y) const { return rgb.data() + std::size_t(y) * std::size_t(width) * 3; }
};

/// Samples and errors by pixel, row 0 on top.
struct SampleMaps {
  std::vector<std::uint32_t> samples;  ///< [height * width] samples taken of each pixel
  /// [height * width] estimated standard error, root mean square of the channels
  std::vector<float> error;
};

}  // namespace grelha
