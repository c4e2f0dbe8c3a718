#pragma once
// The primitives that meet a beam beside what its corner rays met.

#include "kernel/features/beam.hpp"
#include "kernel/features/corner_hits.hpp"

namespace grelha::GRELHA_ISA {

/// Takes the primitives that meet the beam before w = `far`, other than `known`.
class MetInBeam {
 public:
  /// `single`: the first ends the search.
  MetInBeam(const SceneView& scene,
            const BeamFrame& f,
            float far,
            const std::uint32_t (&known)[kCorners],
            bool single,
            Met& met)
      : scene_(scene), f_(f), far_(far), known_(known), single_(single), met_(met) {}

  void operator()(std::uint32_t id) const {
    if (met_.full || any_of(known_, [id](std::uint32_t known) { return id == known; }))
      return;
    PartInBeam part;
    const auto is_copy = [&](std::uint32_t of) { return are_copies(scene_.geometry, id, of); };
    if (!meets(scene_, f_, id, far_, part) || any_of(known_, is_copy))
      return;
    for (int i = 0; i < met_.size; ++i)
      if (met_.part[i].point.x == part.point.x && is_copy(met_.id[i])) {
        met_.id[i] = id < met_.id[i] ? id : met_.id[i];
        return;
      }
    if (met_.size == kMostMet || single_) {
      met_.full = true;
      return;
    }
    met_.id[met_.size] = id;
    met_.part[met_.size++] = part;
  }

 private:
  const SceneView& scene_;
  const BeamFrame& f_;
  const float far_;
  const std::uint32_t (&known_)[kCorners];
  const bool single_;
  Met& met_;
};

/// Whether a beam walks a grid: it goes where all of its edges go, and the grid of rays that start
/// far away holds for those that start near as well. It also walks one that rays from afar walk one
/// by one: what a frustum allows for grows with the way, as what rays in float stray by.
inline bool walks(const GridView& g, const WalkingRays& p) {
  if (g.serves == Serves::kNearAndAfar)
    return true;
  bool all = true;
  bool some = false;
  for (int i = 0; i < kCorners; ++i) {
    const bool served = serves(g, {p.org[0][i], p.org[1][i], p.org[2][i]});
    all &= served;
    some |= served;
  }
  return g.serves == Serves::kNear ? all : some;
}

/// The edges of the pyramid as a packet, with w for t, up to w = `far`. They start where the beam
/// does, however far from the scene: brought near one by one, as rays are, they would not hold what
/// lies between them, nor would frustums allow for the rounding of the way.
[[gnu::always_inline]] inline void set_edges(const BeamFrame& f, float far, Packet<InFloat>& p) {
  p.size = kCorners;
  for (int i = 0; i < kCorners; ++i) {
    const float x = i == 1 || i == 2 ? 1.f : -1.f;
    const float y = i >= 2 ? 1.f : -1.f;
    const Vec3f dir = f.axis + x * f.right + y * f.up;
    set_ray(p, i, f.apex + f.depth * dir, dir, kBehindHit * far - f.depth);
  }
  prepare(p, false);
}

/// The axis along which a direction goes farthest.
[[gnu::always_inline]] inline int main_axis(const Vec3f& dir) {
  const float x = magnitude(dir.x);
  const float y = magnitude(dir.y);
  const float z = magnitude(dir.z);
  if (x >= y && x >= z)
    return 0;
  return y >= z ? 1 : 2;
}

/// Primitives that meet the beam before w = `far`, other than `known`, by their ids; false when no
/// answer can be had, or when `single` and there is one: then which are found depends on the grids.
inline bool collect(const SceneView& scene,
                    const BeamFrame& f,
                    float far,
                    const std::uint32_t (&known)[kCorners],
                    bool single,
                    Met& met,
                    Counters& n) {
  const MetInBeam see(scene, f, far, known, single, met);
  see_outside(scene.outside, see);
  if (met.full)
    return false;
  Packet<InFloat> p;
  if (scene.grid_count > 0)
    set_edges(f, far, p);
  const int axis = main_axis(f.unit);
  for (int i = 0; i < scene.grid_count; ++i) {
    const GridView& g = scene.grids[i];
    if (walks(g, p))
      walk_beam(g, p, axis, see, n);
    if (met.full)
      return false;
  }
  met.sort();
  return true;
}

}  // namespace grelha::GRELHA_ISA
