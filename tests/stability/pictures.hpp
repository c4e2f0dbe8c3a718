#pragma once
// Effects where renderers break: whole pictures with a known answer. Nothing here has a counterpart
// in a library that traces rays.

#include <cstdint>
#include <string>
#include <vector>

namespace grelha::stability {

struct PictureCounts {
  std::uint64_t pixels = 0, wrong = 0;
  std::string first;
};

struct PictureRow {
  const char* name;
  const char* condition;
  const char* truth;
  PictureCounts (*run)(int size);  ///< pictures of size x size pixels
};

std::vector<PictureRow> picture_rows();

}  // namespace grelha::stability
