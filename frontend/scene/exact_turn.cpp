#include "frontend/scene/exact_turn.hpp"

#include "kernel/base/expansion.hpp"

namespace grelha {

int exactly_summed_turn(const Point2& a, const Point2& b, const Point2& c) {
  if (a == b || b == c || c == a)
    return 0;
  Expansion sum;
  sum.add_product(b.x, c.y);
  sum.add_product(-b.x, a.y);
  sum.add_product(-a.x, c.y);
  sum.add_product(-b.y, c.x);
  sum.add_product(b.y, a.x);
  sum.add_product(a.y, c.x);
  return sum.sign();
}

}  // namespace grelha
