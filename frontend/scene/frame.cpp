#include "frontend/scene/frame.hpp"

#include <cmath>
#include <cstdio>

namespace grelha {

std::string text_of(const Frame& frame) {
  const auto number = [](double x) {
    char text[32];
    std::snprintf(text, sizeof text, "%.17g", x);
    return std::string(text);
  };
  std::string text = "counted from " + number(frame.offset[0]) + ' ' + number(frame.offset[1]) +
                     ' ' + number(frame.offset[2]);
  if (frame.scale != 1)
    text += ", enlarged 2^" + std::to_string(std::ilogb(frame.scale)) + " times";
  return text;
}

}  // namespace grelha
