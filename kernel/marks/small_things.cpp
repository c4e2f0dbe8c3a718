#include "kernel/marks/small_things.hpp"

#include <atomic>
#include <mutex>
#include <span>

#include "kernel/marks/mesh_rims.hpp"
#include "kernel/marks/mesh_thickness.hpp"
#include "kernel/marks/to_picture.hpp"
#include "kernel/scene/pixel_box.hpp"
#include "kernel/scene/turns.hpp"

namespace grelha {
namespace {

/// Pixels: what is wider holds whole ones, however it lies on them.
constexpr double kThin = 2;
/// Share of a pixel that beams are wider than pixels, and what rounding may move.
constexpr double kMargin = .1;
/// Where planes have no end: pixels are looked at that are so much wider than those at the farthest
/// of all else (a choice).
constexpr double kBeyond = 8;
/// A flat mirror shows nothing from farther away than so many times the farthest corner of the
/// scene: the way to the mirror, and once across.
constexpr double kByMirror = 3;
/// Things in front of whose shadows every pixel is asked: as many as pixels over this.
constexpr std::size_t kPixelsAThing = 2;
constexpr std::size_t kThingsOfTurn = 1024;
constexpr int kMostPlaces = 64;  ///< of a rod that its shadow is followed from

/// Where thin things may show, and those among them that are small.
struct Marks {
  PixelMarks& thin;
  PixelMarks& small;
};

/// Whether a rod looks thin to the eye; what of it lies behind that is cut off.
bool looks_thin(const ToPicture& to, Rod& rod) {
  return cut_behind(to, rod) &&
         rod.width < kThin * to.pixel(std::max(to(rod.end[0]).depth, to(rod.end[1]).depth));
}

void mark_seen(const ToPicture& to, const Rod& rod, const Marks& marks) {
  const ToPicture::Spot a = to(rod.end[0]);
  const ToPicture::Spot b = to(rod.end[1]);
  const double reach = to.reach(rod.aside, std::min(a.depth, b.depth));
  mark_way(a, b, reach + kMargin, marks.thin);
  if (std::max(std::abs(a.x - b.x), std::abs(a.y - b.y)) + 2 * reach < kThin)
    mark_way(a, b, reach + kMargin, marks.small);
}

/// Rays from a light behind points of rods, and what becomes of their shadows there.
class Shadows {
 public:
  Shadows(const World::Impl& world,
          const Setup& setup,
          const ToPicture& to,
          const float* light,
          const Marks& marks,
          TraceCounts& counts)
      : world_(world),
        setup_(setup),
        to_(to),
        light_{light[0], light[1], light[2]},
        marks_(marks),
        counts_(counts) {}

  void add(const Rod& rod) {
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
    small_[count_] = rod.length() <= 2 * rod.width;
    ++count_;
    return true;
  }

  const World::Impl& world_;
  const Setup& setup_;
  const ToPicture& to_;
  const float light_[3];
  const Marks marks_;
  TraceCounts& counts_;
  int count_ = 0;
  float dir_[3][kRoom], t_min_[kRoom], reach_[kRoom], half_width_[kRoom];
  bool goes_on_[kRoom], small_[kRoom];
};

/// Marks what small things there are.
class Marker {
 public:
  Marker(const World::Impl& world,
         const Setup& setup,
         int threads,
         SmallThings& things,
         TraceCounts& counts)
      : world_(world),
        setup_(setup),
        g_(world.primitives.geometry),
        threads_(threads),
        to_(setup.frame),
        widest_(kThin * widest_pixel()),
        thickness_(world, setup),
        things_(things),
        counts_(counts) {}

  void run() {
    mark_things_seen();
    things_.mirrored = has_loner(kThin * kByMirror * to_.pixel(farthest()));
    for (int l = 0; l < world_.shading.light_count; ++l) {
      PixelMarks& shadows = things_.shadows[static_cast<std::size_t>(l % kLightBits)];
      mark_shadows(world_.shading.lights + kLightFloats * l, {shadows, things_.small});
    }
  }

 private:
  /// Of all pixels that anything finite is seen in.
  double widest_pixel() const {
    const SceneView& v = world_.view;
    double most = 0;
    for (int k = 0; k < 8; ++k) {
      const Place3 corner = {k & 1 ? v.box_hi[0] : v.box_lo[0],
                             k & 2 ? v.box_hi[1] : v.box_lo[1],
                             k & 4 ? v.box_hi[2] : v.box_lo[2]};
      most = std::max(most, to_(corner).depth);
    }
    return to_.pixel(most) * (g_.planes.size() > 0 ? kBeyond : 1);
  }

  /// Distance of the farthest corner of all that is finite, in lengths of `forward`.
  double farthest() const {
    const SceneView& v = world_.view;
    double square = 0;
    for (int a = 0; a < 3; ++a) {
      const double most = std::max(std::abs(static_cast<double>(v.box_lo[a]) - to_.eye[a]),
                                   std::abs(static_cast<double>(v.box_hi[a]) - to_.eye[a]));
      square += most * most;
    }
    return to_.depth_of(std::sqrt(square));
  }

  /// Whether anything that is no part of a larger mesh is thinner than that.
  bool has_loner(double width) const {
    for (std::size_t i = 0; i < g_.spheres.size(); ++i)
      if (rod_of(g_.spheres, i).width < width)
        return true;
    for (std::size_t i = 0; i < g_.cones.size(); ++i)
      if (rod_of(g_.cones, i).width < width)
        return true;
    for (std::size_t i = 0; i < g_.triangles.size(); ++i)
      if (rims_->stands_alone(i) && rod_of(g_.triangles, i, to_.eye).width < width)
        return true;
    return false;
  }

  void look_from(const Place3& point) {
    if (g_.triangles.size() == 0)
      return;
    if (!rims_)
      rims_ = std::make_unique<MeshRims>(g_.triangles, threads_);
    rims_->look_from(point);
  }

  std::size_t turns() const {
    return (g_.spheres.size() + g_.cones.size() + g_.triangles.size() + kThingsOfTurn - 1) /
           kThingsOfTurn;
  }

  Rod rod_at(std::size_t i, const Place3& from) const {
    const std::size_t cones = g_.spheres.size();
    const std::size_t triangles = cones + g_.cones.size();
    return i < cones       ? rod_of(g_.spheres, i)
           : i < triangles ? rod_of(g_.cones, i - cones)
                           : rod_of(g_.triangles, i - triangles, from);
  }

  /// Calls take(rod, alone) for the things of a turn that is_thin(rod) holds for, as seen from a
  /// point.
  template <class IsThin, class Take>
  void each_thing(std::size_t turn,
                  const Place3& from,
                  const IsThin& is_thin,
                  const Take& take,
                  TraceCounts& counts) const {
    const std::size_t triangles = g_.spheres.size() + g_.cones.size();
    const std::size_t end = std::min((turn + 1) * kThingsOfTurn, triangles + g_.triangles.size());
    std::uint32_t outlines[kThingsOfTurn];
    std::size_t count = 0;
    for (std::size_t i = turn * kThingsOfTurn; i < end; ++i) {
      const Rod rod = rod_at(i, from);
      if (!is_thin(rod))
        continue;
      const std::size_t triangle = i - triangles;
      if (i < triangles || rims_->ends_at(triangle))
        take(rod, i < triangles || rims_->stands_alone(triangle));
      else if (rims_->has(triangle))
        outlines[count++] = static_cast<std::uint32_t>(triangle);
    }
    take_outlines({outlines, count}, from, is_thin, take, counts);
  }

  /// The same of triangles inside of meshes, which are as thick as these are there at least.
  template <class IsThin, class Take>
  void take_outlines(std::span<const std::uint32_t> outlines,
                     const Place3& from,
                     const IsThin& is_thin,
                     const Take& take,
                     TraceCounts& counts) const {
    double thickness[kThingsOfTurn];
    thickness_.measure(outlines, thickness, counts);
    for (std::size_t k = 0; k < outlines.size(); ++k) {
      Rod rod = rod_of(g_.triangles, outlines[k], from);
      rod.width = std::max(rod.width, thickness[k]);
      if (is_thin(rod))
        take(rod, false);
    }
  }

  void mark_things_seen() {
    look_from(to_.eye);
    std::atomic<bool> stand_alone = false;
    const Marks marks{things_.thin, things_.small};
    each_turn(turns(), threads_, [&](std::size_t turn) {
      TraceCounts counts;
      const auto is_thin = [&](Rod rod) { return looks_thin(to_, rod); };
      const auto mark = [&](Rod rod, bool alone) {
        cut_behind(to_, rod);
        mark_seen(to_, rod, marks);
        if (alone)
          stand_alone = true;
      };
      each_thing(turn, to_.eye, is_thin, mark, counts);
      add(counts);
    });
    things_.stand_alone = stand_alone;
  }

  void mark_shadows(const float* light, const Marks& marks) {
    const Place3 from = {light[0], light[1], light[2]};
    look_from(from);
    const std::size_t most = static_cast<std::size_t>(setup_.frame.width) *
                             static_cast<std::size_t>(setup_.frame.height) / kPixelsAThing;
    std::atomic<std::size_t> thin = 0;
    each_turn(turns(), threads_, [&](std::size_t turn) {
      TraceCounts counts;
      Shadows shadows(world_, setup_, to_, light, marks, counts);
      const auto is_thin = [&](const Rod& rod) { return rod.width < widest_; };
      const auto follow = [&](const Rod& rod, bool) {
        if (thin++ < most)
          shadows.add(rod);
      };
      each_thing(turn, from, is_thin, follow, counts);
      shadows.follow();
      add(counts);
    });
    if (thin > most) {
      marks.thin.mark_all();
      marks.small.mark_all();
    }
  }

  void add(const TraceCounts& counts) {
    const std::lock_guard lock(sum_);
    counts_ += counts;
  }

  const World::Impl& world_;
  const Setup& setup_;
  const GeometrySpans& g_;
  const int threads_;
  const ToPicture to_;
  const double widest_;
  const MeshThickness thickness_;
  SmallThings& things_;
  TraceCounts& counts_;
  std::mutex sum_;
  std::unique_ptr<MeshRims> rims_;
};

}  // namespace

SmallThings::SmallThings(const World::Impl& world,
                         const Setup& setup,
                         int threads,
                         TraceCounts& counts)
    : thin(setup.frame.width, setup.frame.height), small(setup.frame.width, setup.frame.height) {
  for (int l = 0; l < std::min(world.shading.light_count, kLightBits); ++l)
    shadows.emplace_back(setup.frame.width, setup.frame.height);
  Marker marker(world, setup, threads, *this, counts);
  marker.run();
}

std::uint64_t SmallThings::lights(int x, int y) const {
  std::uint64_t bits = 0;
  for (std::size_t l = 0; l < shadows.size(); ++l)
    bits |= std::uint64_t{shadows[l].has(x, y)} << l;
  return bits;
}

}  // namespace grelha
