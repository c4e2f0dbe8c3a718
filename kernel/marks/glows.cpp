#include "kernel/marks/glows.hpp"

#include <numbers>

#include "kernel/marks/to_picture.hpp"

namespace grelha {
namespace {

constexpr int kLevels = 24;  ///< brighter lamps count as the last
/// Pixels: what a lens spreads no farther beams look for as though there were none.
constexpr double kInFocus = .5;

class GlowMarker {
 public:
  GlowMarker(const World::Impl& world,
             const Setup& setup,
             double least,
             std::vector<PixelMarks>& levels)
      : materials_(world.shading.materials),
        frame_(setup.frame),
        to_(setup.frame),
        least_(least),
        levels_(levels) {}

  template <class Spans, class RodOf>
  void mark_all(const Spans& things, const RodOf& rod_of_thing) {
    for (std::size_t i = 0; i < things.size(); ++i)
      if (const float sent = sent_by(things.material[i]); sent > 1)
        mark(rod_of_thing(i), sent);
  }
  Place3& eye() { return to_.eye; }

 private:
  float sent_by(std::uint32_t material) const {
    float most = 0;
    for (int c = 0; c < 3; ++c)
      most = std::max(most, materials_.field[kEmissionR + c][material]);
    return most;
  }

  /// Pixels from where the middle of the lens sees a place to where its rim does.
  double spread(double depth) const {
    double square = 0;
    for (const float x : frame_.lens_right)
      square += double{x} * x;
    const double focus = double{frame_.focus};
    return std::abs(focus / depth - 1) * std::sqrt(square) / to_.pixel(focus);
  }

  /// Share of the samples of its pixels that meet a rod: what of the lens's disc it covers.
  double share(const Rod& rod, double depth, double spread) const {
    const double wide = rod.width / to_.pixel(depth);
    const double area = wide * (std::numbers::pi / 4 * wide + rod.length() / to_.pixel(depth));
    return std::min(1., area / (std::numbers::pi * spread * spread));
  }

  void mark(Rod rod, float sent) {
    if (!cut_behind(to_, rod))
      return;
    const ToPicture::Spot a = to_(rod.end[0]);
    const ToPicture::Spot b = to_(rod.end[1]);
    const double most = std::max(spread(a.depth), spread(b.depth));
    const double depth = std::min(a.depth, b.depth);
    if (most < kInFocus ||
        share(rod, depth, std::min(spread(a.depth), spread(b.depth))) * double{sent} < least_)
      return;
    const int level = std::min(std::ilogb(sent), kLevels - 1);
    while (levels_.size() <= static_cast<std::size_t>(level))
      levels_.emplace_back(frame_.width, frame_.height);
    mark_way(
        a, b, most + to_.reach(rod.aside, depth) + 1, levels_[static_cast<std::size_t>(level)]);
  }

  const MaterialView& materials_;
  const FrameView& frame_;
  ToPicture to_;
  const double least_;
  std::vector<PixelMarks>& levels_;
};

}  // namespace

Glows::Glows(const World::Impl& world, const Setup& setup, double least) {
  if (!setup.frame.lens || !(world.shading.brightest > 1))
    return;
  const GeometrySpans& g = world.primitives.geometry;
  GlowMarker marker(world, setup, least, levels_);
  marker.mark_all(g.spheres, [&](std::size_t i) { return rod_of(g.spheres, i); });
  marker.mark_all(g.cones, [&](std::size_t i) { return rod_of(g.cones, i); });
  marker.mark_all(g.triangles, [&](std::size_t i) { return rod_of(g.triangles, i, marker.eye()); });
}

float Glows::brightest(int x, int y) const {
  for (std::size_t level = levels_.size(); level-- > 0;)
    if (levels_[level].has(x, y))
      return std::ldexp(1.f, static_cast<int>(level + 1));
  return 0;
}

}  // namespace grelha
