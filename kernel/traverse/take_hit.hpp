#pragma once
// Takes hits of one ray, alone or in a packet: the rules of ties, filters and ends of searches.

#include "kernel/traverse/single_ray.hpp"

namespace grelha::GRELHA_ISA {

/// Takes one hit. Returns whether the search is over (kAny and something was hit).
template <bool kAny, class Ray>
[[gnu::always_inline]] inline bool take_hit(Ray& r, const CrossingSpan& t, std::uint32_t id) {
  if (!(t.lo <= best_of(r)))
    return false;
  if (const RayFilter* const filter = frame_of(r).filter) [[unlikely]] {
    id = filter->hit_of(index_of(r), id);
    if (id == kNoPrimitive)
      return false;
  }
  CrossingSpan first = t;
  if (!(t.hi < low_of(r))) {
    if (id == id_of(r))
      return false;
    id = settle_tie(frame_of(r), index_of(r), id_of(r), id, first);
    if (id == kNoPrimitive)
      return false;
  }
  set_hit(r, first, id);
  return kAny;
}

/// The same of a ray of a packet, which with kAny stops searching.
template <bool kAny>
[[gnu::noinline]] void take_hit(Packet& p, int i, const CrossingSpan& t, std::uint32_t id) {
  PacketRay r{p, i};
  if (take_hit<kAny>(r, t, id))
    set_hit(r, {-kInfinity, -kInfinity}, id_of(r));
}

}  // namespace grelha::GRELHA_ISA
