#pragma once
// The kinds of rays a render traces, made from a scene's own first hits, in the order a render
// makes them.

#include <array>

#include "kernel/scene/shading_view.hpp"
#include "perf/workloads.hpp"

namespace grelha::perf {

struct FirstHit;

enum class RayKind { kPrimary, kLens, kShadow, kArea, kMirror, kGlossy, kScattered, kMirrorShadow };
inline constexpr std::array<const char*, 8> kRayKinds = {"primary",
                                                         "AA + lens",
                                                         "hard shadow",
                                                         "area 16",
                                                         "mirror",
                                                         "glossy 16",
                                                         "scattered",
                                                         "shadow of mirror hits"};

/// Makes ray sets of a picture of size x size, in tiles of 8 x 8 pixels. Of larger pictures than
/// 512 x 512 one strip of four tiles of each block of strips is taken, so that sets are about as
/// large; of all, one in 16 for the kinds of 16 rays a point or pixel.
///
/// primary      through the centre of every pixel
/// AA + lens    16 samples of a pixel side by side, through the scene's own lens or one of 12
///              pixels
/// hard shadow  from each first hit that faces the first light to that light
/// area 16      16 from each such hit to a square in its place, a tenth as wide as it is far from
///              the point looked at
/// mirror       from each first hit, whatever it is made of
/// glossy 16    16 around each such direction, in a lobe of roughness .1
/// scattered    from each first hit in a direction spread as diffuse light is
/// shadow of mirror hits   hard shadow rays from the hits of `mirror`
class RayMaker {
 public:
  RayMaker(const SceneFile& file, const World& world, int size);  ///< size: at least 32
  RayBuffer make(RayKind kind) const;
  /// Rays to a point light.
  static constexpr bool to_point(RayKind kind) {
    return kind == RayKind::kShadow || kind == RayKind::kMirrorShadow;
  }
  static bool any_hit(RayKind kind) { return to_point(kind) || kind == RayKind::kArea; }
  /// Returns the position of the light that shadow rays go to.
  Float3 light() const { return light_.position; }

 private:
  RayBuffer through_pixels(const FrameView& frame, int samples, bool few) const;
  std::vector<FirstHit> first_hits(bool few) const;
  std::vector<FirstHit> hits_of(const RayBuffer& rays) const;

  const World& world_;
  FrameView pinhole_, lens_;
  Light light_;
  bool lit_ = false;
};

}  // namespace grelha::perf
