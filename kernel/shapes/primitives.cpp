#include "kernel/shapes/primitives.hpp"

namespace grelha {

Primitives::Primitives(const GeometrySpans& g) : geometry(g), sources_(g) {
  std::uint32_t next = 0;
  for_each_shape([&]<class Shape>() {
    ids.first[kNumber<Shape>] = next;
    next += static_cast<std::uint32_t>(of<Shape>().size());
  });
  ids.first[kKinds] = next;
}

}  // namespace grelha
