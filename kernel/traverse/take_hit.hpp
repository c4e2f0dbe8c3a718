#pragma once
// Takes hits of one ray, alone or in a packet: the rules of ties, filters and ends of searches.

#include "kernel/traverse/single_ray.hpp"

namespace grelha::GRELHA_ISA {

/// Takes a hit that floats cannot tell from ray i's hit so far, `held`, or from the end of its
/// search: returns which counts, or kNoPrimitive, and `span` of the first one.
[[gnu::noinline, gnu::cold]] inline std::uint32_t settle_tie(
    const RayFrame& frame, int i, std::uint32_t held, std::uint32_t id, CrossingSpan& span) {
  const ExactRay ray = frame.given.ray(i);
  const double shift = frame.given.shift_of(i);
  if (held != kNoPrimitive && meet_on_axis(*frame.geometry, ray, id, held))
    return id < held ? id : held;  // `span` holds t of both
  if (held != kNoPrimitive)
    return is_closest(*frame.geometry, ray, id, held, shift, span) ? id : held;
  if (!is_before_end(*frame.geometry, ray, id))
    return kNoPrimitive;
  span = crossing_span(*frame.geometry, ray, id, shift);
  return id;
}

/// Takes one hit. Returns whether the search is over (kAny and something was hit).
template <bool kAny, class Ray>
[[gnu::always_inline]] inline bool take_hit(Ray r, const CrossingSpan& t, std::uint32_t id) {
  if (!(t.lo <= r.rays.best[r.i]))
    return false;
  if (const RayFilter* const filter = r.rays.filter) [[unlikely]] {
    id = filter->hit_of(r.i, id);
    if (id == kNoPrimitive)
      return false;
  }
  CrossingSpan first = t;
  if (!(t.hi < r.rays.low[r.i])) {
    if (id == id_of(r))
      return false;
    id = settle_tie(r.rays, r.i, id_of(r), id, first);
    if (id == kNoPrimitive)
      return false;
  }
  set_hit(r, first, id);
  return kAny;
}

/// The same of a ray of a packet, which with kAny stops searching.
template <bool kAny>
[[gnu::noinline]] void take_hit(Packet& p, int i, const CrossingSpan& t, std::uint32_t id) {
  const PacketRay r{p, i};
  if (take_hit<kAny>(r, t, id))
    set_hit(r, {-kInfinity, -kInfinity}, id_of(r));
}

}  // namespace grelha::GRELHA_ISA
