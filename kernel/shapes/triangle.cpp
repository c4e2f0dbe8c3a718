#include "kernel/shapes/triangle.hpp"

namespace grelha {

bool Triangle::is_even(const TriangleSpans& spans) {
  const std::size_t size = spans.size();
  const std::size_t vertices = spans.vertex_count();
  const auto has = [vertices](const Floats& x, const Floats& y, const Floats& z, bool any) {
    const std::size_t count = any ? vertices : 0;
    return x.size() == count && y.size() == count && z.size() == count;
  };
  return spans.b.size() == size && spans.c.size() == size && spans.material.size() == size &&
         has(spans.x, spans.y, spans.z, true) &&
         has(spans.nx, spans.ny, spans.nz, !spans.nx.empty()) &&
         has(spans.red, spans.green, spans.blue, !spans.red.empty());
}

Triangle::Arrays Triangle::Source::arrays() const {
  Arrays out{
      .vertex = {spans.x.data(), spans.y.data(), spans.z.data()},
      .corner = {spans.a.data(), spans.b.data(), spans.c.data()},
      .material = spans.material.data(),
      .count = static_cast<std::uint32_t>(size()),
  };
  const auto put = [](const float*(&to)[3], const Floats& x, const Floats& y, const Floats& z) {
    if (x.empty())
      return;
    to[0] = x.data();
    to[1] = y.data();
    to[2] = z.data();
  };
  put(out.normal, spans.nx, spans.ny, spans.nz);
  put(out.color, spans.red, spans.green, spans.blue);
  return out;
}

}  // namespace grelha
