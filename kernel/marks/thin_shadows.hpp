#pragma once
// Where the shadows of thin things show.

#include <algorithm>
#include <atomic>
#include <cmath>

#include "grelha/stats.hpp"
#include "kernel/marks/to_picture.hpp"
#include "kernel/query/variants.hpp"
#include "kernel/render/setup.hpp"
#include "kernel/world/world_impl.hpp"

namespace grelha {

/// Pixels: what is wider holds whole ones, however it lies on them.
inline constexpr double kThin = 2;

/// Where thin things may show, and those among them that are small.
struct Marks {
  PixelMarks& thin;
  PixelMarks& small;
};

/// A light, and what all threads share that follow its shadows.
struct ShadowCaster {
  const Place3& position;
  double widest;  ///< below it a rod may be thin
  Marks marks;
  std::size_t most;  ///< of more rods no shadow is followed: it may be anywhere
  std::atomic<std::size_t> rods = 0;

  bool is_anywhere() const { return rods > most; }
};

/// Rays from a light behind points of rods, and what becomes of their shadows there.
class ThinShadows {
 public:
  ThinShadows(const World::Impl& world,
              const Setup& setup,
              const ToPicture& to,
              ShadowCaster& light,
              TraceCounts& counts)
      : world_(world),
        setup_(setup),
        to_(to),
        caster_(light),
        light_{static_cast<float>(light.position[0]),
               static_cast<float>(light.position[1]),
               static_cast<float>(light.position[2])},
        marks_(light.marks),
        counts_(counts) {}

  /// The width below which a rod may be thin.
  double thin(const Rod&) const { return caster_.widest; }
  /// Whether nothing is to be told of a thin one.
  bool is_known(const Rod&) const { return caster_.is_anywhere(); }

  void add(const Rod& rod) {
    if (caster_.rods++ >= caster_.most)
      return;
    const double depth = std::max(std::abs(to_(rod.end[0]).depth), std::abs(to_(rod.end[1]).depth));
    const double apart = std::max({2 * rod.width, to_.pixel(depth), 1e-300});
    const int points =
        static_cast<int>(std::clamp(std::ceil(rod.length() / apart), 1., double{kMostPlaces}));
    bool goes_on = false;
    for (int k = 0; k < points; ++k)
      goes_on = add_point(rod, points > 1 ? k / (points - 1.) : .5, goes_on);
    if (count_ + kMostPlaces > kRoom)
      follow();
  }

  void follow() {
    const float from[3] = {light_[0], light_[1], light_[2]};
    Rays rays{.org = {&from[0], &from[1], &from[2]},
              .dir = {dir_[0], dir_[1], dir_[2]},
              .t_min = t_min_,
              .count = static_cast<std::size_t>(count_),
              .org_stride = 0};
    float t[kRoom];
    std::uint32_t id[kRoom];
    setup_.variant.loops.closest(world_.view, rays, {.t = t, .id = id}, {}, counts_);
    ToPicture::Spot last{};
    bool held = false;
    for (int i = 0; i < count_; ++i) {
      if (id[i] == kNoPrimitive) {
        held = false;
        continue;
      }
      Place3 at;
      for (int a = 0; a < 3; ++a)
        at[a] = light_[a] + static_cast<double>(t[i]) * dir_[a][i];
      const ToPicture::Spot spot = to_(at);
      if (!(spot.depth > 0)) {
        held = false;
        continue;
      }
      const double reach = to_.reach(double{reach_[i]} * double{t[i]}, spot.depth) + 1;
      const bool near = std::abs(spot.x - last.x) < kJoined && std::abs(spot.y - last.y) < kJoined;
      const bool joined = held && goes_on_[i] && (near || id[i] == id[i - 1]);
      if (half_width_[i] * t[i] < kThin * to_.pixel(spot.depth))
        mark(joined ? last : spot, spot, reach, small_[i]);
      last = spot;
      held = true;
    }
    count_ = 0;
  }

 private:
  static constexpr int kMostPlaces = 64;  ///< of a rod that its shadow is followed from
  static constexpr int kRoom = 320;
  /// Pixels: nearer shadows of one rod are one, and so are those on one primitive.
  static constexpr double kJoined = 16;

  void mark(const ToPicture::Spot& from, const ToPicture::Spot& to, double reach, bool small) {
    mark_way(from, to, reach, marks_.thin);
    if (small)
      mark_way(from, to, reach, marks_.small);
  }

  /// How far behind a place of its axis a ray leaves a rod, at its side or its end; `part` of the
  /// rod lies before the place.
  static double way_out(const Rod& rod, double part, const double (&ray)[3], double ray_length) {
    const double length = rod.length();
    if (!(length > 0))
      return rod.reach;
    double along = 0;
    for (int a = 0; a < 3; ++a)
      along += (rod.end[1][a] - rod.end[0][a]) * ray[a];
    const double cosine = along / (length * ray_length);
    const double sine = std::sqrt(std::max(1 - cosine * cosine, 0.));
    const double to_end = (cosine > 0 ? 1 - part : part) * length * std::abs(cosine);
    const double at_end = to_end + rod.reach * sine;
    return sine * at_end < rod.reach ? at_end : rod.reach / sine;
  }

  /// A ray to a place of a rod; `goes_on`: after one to the place before. False: there is none.
  bool add_point(const Rod& rod, double part, bool goes_on) {
    double ray[3];
    double square = 0;
    for (int a = 0; a < 3; ++a) {
      ray[a] = rod.end[0][a] + part * (rod.end[1][a] - rod.end[0][a]) - light_[a];
      dir_[a][count_] = static_cast<float>(ray[a]);
      square += ray[a] * ray[a];
    }
    const double length = std::sqrt(square);
    if (!(length > rod.reach))
      return false;
    const double out = way_out(rod, part, ray, length);
    t_min_[count_] = static_cast<float>(1 + 1.01 * out / length + 1e-6);
    reach_[count_] = static_cast<float>(rod.aside);
    half_width_[count_] = static_cast<float>(std::max(rod.aside, .5 * rod.width));
    goes_on_[count_] = goes_on;
    small_[count_] = std::max(rod.length(), rod.whole) <= 2 * rod.width;
    ++count_;
    return true;
  }

  const World::Impl& world_;
  const Setup& setup_;
  const ToPicture& to_;
  ShadowCaster& caster_;
  const float light_[3];
  const Marks marks_;
  TraceCounts& counts_;
  int count_ = 0;
  float dir_[3][kRoom], t_min_[kRoom], reach_[kRoom], half_width_[kRoom];
  bool goes_on_[kRoom], small_[kRoom];
};

}  // namespace grelha
