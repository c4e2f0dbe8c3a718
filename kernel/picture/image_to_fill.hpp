#pragma once
// A picture whose pixels are soon written.

#include "grelha/image.hpp"
#include "kernel/base/pages.hpp"

namespace grelha {

/// Image(width, height).
inline Image image_to_fill(int width, int height) {
  Image image;
  image.width = width;
  image.height = height;
  resize_to_fill(image.rgb, static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
  return image;
}

}  // namespace grelha
