#include "kernel/picture/subdivision.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <omp.h>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "grelha/subdivision.hpp"
#include "kernel/shade/strips.hpp"
#include "kernel/shade/workspace.hpp"
#include "kernel/base/parallel_for.hpp"
#include "kernel/world/world_impl.hpp"

namespace grelha {
namespace {

bool is_side(int side) {
  return side >= 1 && side <= kMostSubdividedSide;
}

}  // namespace

SubdivisionState make_subdivision(int width, int height) {
  if (!is_side(width) || !is_side(height))
    throw std::invalid_argument("a subdivided picture has sides from 1 to " +
                                std::to_string(kMostSubdividedSide));
  SubdivisionState state;
  state.image = Image(width, height);
  return state;
}

bool is_valid(const SubdivisionState& s) {
  return is_side(s.image.width) && is_side(s.image.height) && s.share >= 0 && s.share <= 1 &&
         std::all_of(s.done.begin(), s.done.end(), [](std::uint8_t d) { return d <= 1; });
}

namespace {

/// Pixels a side: with fewer, too many corners lie between tiles.
constexpr int kMostTile = 32, kLeastTile = 8;
constexpr int kTileSteps = 256;  ///< points a side to aim at, if every square is split
constexpr int kCornerBlock = 8;  ///< corners a side of a block that is traced in one go

struct Square {
  LatticePoint at;          ///< upper left corner
  std::uint32_t pixel;      ///< of the tile
  std::uint32_t corner[4];  ///< numbers of points, by rows
};

/// One of the five new points of a split square: 5 square + {above, left, centre, right, below}.
struct Request {
  std::uint64_t key;
  std::uint32_t slot;
};

/// Bits of x at every other place.
std::uint64_t spread(std::uint64_t x) {
  x = (x | x << 16) & 0x0000FFFF0000FFFFu;
  x = (x | x << 8) & 0x00FF00FF00FF00FFu;
  x = (x | x << 4) & 0x0F0F0F0F0F0F0F0Fu;
  x = (x | x << 2) & 0x3333333333333333u;
  return (x | x << 1) & 0x5555555555555555u;
}

/// Position on Morton's curve: points sorted by it are neighbours, for the packets' sake.
std::uint64_t morton(LatticePoint p) {
  return spread(p.x) | spread(p.y) << 1;
}

float clamped(float x) {
  return x < 0 ? 0.f : x > 1 ? 1.f : x;
}

/// True if a channel differs by more than the threshold between two corners.
bool differ(const Float3 (&c)[4], float threshold) {
  const auto differs = [&](float Float3::*channel) {
    const auto [least, most] = std::minmax({clamped(c[0].*channel),
                                            clamped(c[1].*channel),
                                            clamped(c[2].*channel),
                                            clamped(c[3].*channel)});
    return most - least > threshold;
  };
  return differs(&Float3::x) || differs(&Float3::y) || differs(&Float3::z);
}

double sum_of(const Float3 (&c)[4], float Float3::*channel) {
  const double upper = static_cast<double>(c[0].*channel) + c[1].*channel;
  const double lower = static_cast<double>(c[2].*channel) + c[3].*channel;
  return upper + lower;
}

/// Makes one tile.
class TileSubdivider {
 public:
  TileSubdivider(const TileRect& rect, const Subdivision& options, const TracePoints& trace)
      : rect_(rect),
        options_(options),
        trace_(trace),
        sums_(static_cast<std::size_t>(across() - 1) * static_cast<std::size_t>(down() - 1)) {}

  void run(Image& image) {
    trace_vertices();
    for (int level = 0; level < options_.depth && !split_.empty(); ++level)
      split_all(level);
    show(image);
  }

 private:
  /// Corners of pixels a row, and a column.
  int across() const { return rect_.x1 - rect_.x0 + 1; }
  int down() const { return rect_.y1 - rect_.y0 + 1; }

  LatticePoint corner_at(int x, int y) const {
    return {static_cast<std::uint32_t>(rect_.x0 + x) * kLatticeSteps,
            static_cast<std::uint32_t>(rect_.y0 + y) * kLatticeSteps};
  }
  std::uint32_t& id_at(int x, int y) {
    return ids_[static_cast<std::size_t>(y) * static_cast<std::size_t>(across()) +
                static_cast<std::size_t>(x)];
  }

  std::uint32_t number(LatticePoint p) {
    fresh_.push_back(p);
    return static_cast<std::uint32_t>(colours_.size() + fresh_.size() - 1);
  }

  /// Traces the points numbered since the last time.
  void trace_fresh() {
    const std::size_t first = colours_.size();
    colours_.resize(first + fresh_.size());
    trace_(fresh_, colours_.data() + first);
    fresh_.clear();
  }

  /// Level 0, in blocks of points; then every pixel is a square.
  void trace_vertices() {
    ids_.resize(static_cast<std::size_t>(across()) * static_cast<std::size_t>(down()));
    for (int y = 0; y < down(); y += kCornerBlock)
      for (int x = 0; x < across(); x += kCornerBlock)
        number_block(x, y);
    trace_fresh();
    std::uint32_t pixel = 0;
    for (int y = 0; y + 1 < down(); ++y)
      for (int x = 0; x + 1 < across(); ++x, ++pixel)
        resolve(whole_pixel(x, y, pixel), 0, split_);
  }

  Square whole_pixel(int x, int y, std::uint32_t pixel) {
    const std::uint32_t* const upper = &id_at(x, y);
    const std::uint32_t* const lower = &id_at(x, y + 1);
    return {corner_at(x, y), pixel, {upper[0], upper[1], lower[0], lower[1]}};
  }

  void number_block(int x0, int y0) {
    for (int y = y0; y < std::min(y0 + kCornerBlock, down()); ++y)
      for (int x = x0; x < std::min(x0 + kCornerBlock, across()); ++x)
        id_at(x, y) = number(corner_at(x, y));
  }

  /// Splits the squares of `level` that wait for it.
  void split_all(int level) {
    const std::uint32_t half = kLatticeSteps >> (level + 1);
    number_new_points(half);
    trace_fresh();
    next_.clear();
    for (std::size_t i = 0; i < split_.size(); ++i)
      for (const Square& quarter : quarters(split_[i], half, ids_.data() + 5 * i))
        resolve(quarter, level + 1, next_);
    split_.swap(next_);
  }

  /// The quarters of a square with sides of twice `half`; n: its five new points.
  static std::array<Square, 4> quarters(const Square& s,
                                        std::uint32_t half,
                                        const std::uint32_t* n) {
    const auto& [at, pixel, c] = s;
    const std::uint32_t x = at.x + half;
    const std::uint32_t y = at.y + half;
    return {{
        {at, pixel, {c[0], n[0], n[1], n[2]}},
        {{x, at.y}, pixel, {n[0], c[1], n[2], n[3]}},
        {{at.x, y}, pixel, {n[1], n[2], c[2], n[4]}},
        {{x, y}, pixel, {n[2], n[3], n[4], c[3]}},
    }};
  }

  /// Numbers the points that squares to be split have in their middles and halfway between their
  /// corners. These are corners of no square but those split now: a point is born on the one level
  /// whose step it is an odd multiple of.
  void number_new_points(std::uint32_t half) {
    request_new_points(half);
    ids_.resize(requests_.size());
    std::uint32_t id = 0;
    for (std::size_t i = 0; i < requests_.size(); ++i) {
      const auto& [key, slot] = requests_[i];
      if (i == 0 || key != requests_[i - 1].key)
        id = number(new_point(slot, half));
      ids_[slot] = id;
    }
  }

  /// Requests a point for each slot, equal ones side by side.
  void request_new_points(std::uint32_t half) {
    requests_.resize(5 * split_.size());
    for (std::size_t i = 0; i < requests_.size(); ++i)
      requests_[i] = {morton(new_point(i, half)), static_cast<std::uint32_t>(i)};
    std::sort(requests_.begin(), requests_.end(), [](const Request& a, const Request& b) {
      return a.key < b.key;
    });
  }

  /// The point of a slot, see Wanted; `half`: of the sides of the squares.
  LatticePoint new_point(std::size_t slot, std::uint32_t half) const {
    constexpr LatticePoint kHalves[5] = {{1, 0}, {0, 1}, {1, 1}, {2, 1}, {1, 2}};
    const LatticePoint at = split_[slot / 5].at;
    const LatticePoint by = kHalves[slot % 5];
    return {at.x + by.x * half, at.y + by.y * half};
  }

  /// A square whose corners are known joins those to be split, or its pixel's sum. The order of a
  /// pixel's terms is that of its own squares alone.
  void resolve(const Square& s, int level, std::vector<Square>& to_split) {
    const Float3 c[4] = {
        colours_[s.corner[0]], colours_[s.corner[1]], colours_[s.corner[2]], colours_[s.corner[3]]};
    if (level < options_.depth && differ(c, options_.threshold)) {
      to_split.push_back(s);
      return;
    }
    const double share = std::ldexp(.25, -2 * level);
    std::array<double, 3>& sum = sums_[s.pixel];
    sum[0] += share * sum_of(c, &Float3::x);
    sum[1] += share * sum_of(c, &Float3::y);
    sum[2] += share * sum_of(c, &Float3::z);
  }

  void show(Image& image) const {
    const std::array<double, 3>* sum = sums_.data();
    for (int y = rect_.y0; y < rect_.y1; ++y) {
      float* out = image.row(y) + 3 * static_cast<std::size_t>(rect_.x0);
      for (int x = rect_.x0; x < rect_.x1; ++x, ++sum)
        for (const double channel : *sum)
          *out++ = static_cast<float>(channel);
    }
  }

  const TileRect rect_;
  const Subdivision& options_;
  const TracePoints& trace_;
  std::vector<Float3> colours_;       ///< of points, by number
  std::vector<LatticePoint> fresh_;   ///< those that have numbers and no colours yet
  std::vector<std::uint32_t> ids_;    ///< of corners by rows, or of new points by slot
  std::vector<Square> split_, next_;  ///< squares that wait to be split
  std::vector<Request> requests_;
  std::vector<std::array<double, 3>> sums_;  ///< [pixels]
};

}  // namespace

Tiles::Tiles(const Image& image, const Subdivision& options, int side)
    : width_(image.width),
      height_(image.height),
      side_(side > 0 ? side : std::clamp(kTileSteps >> options.depth, kLeastTile, kMostTile)),
      rows_(static_cast<std::size_t>((height_ - 1) / side_ + 1)),
      columns_(static_cast<std::size_t>((width_ - 1) / side_ + 1)) {}

TileRect Tiles::operator[](std::size_t tile) const {
  const int x0 = static_cast<int>(tile % columns_) * side_;
  const int y0 = static_cast<int>(tile / columns_) * side_;
  return {x0, y0, std::min(x0 + side_, width_), std::min(y0 + side_, height_)};
}

void check_subdivision(const Subdivision& options) {
  if (!(options.threshold >= 0) || options.threshold > 1)
    throw std::invalid_argument("the threshold of subdivision must be from 0 to 1");
  if (options.depth < 0 || options.depth > kMostSubdivisions)
    throw std::invalid_argument("the depth of subdivision must be from 0 to " +
                                std::to_string(kMostSubdivisions));
}

void subdivide(const TileRect& tile,
               const Subdivision& options,
               const TracePoints& trace,
               Image& image) {
  TileSubdivider(tile, options, trace).run(image);
}

namespace {

constexpr std::size_t kMostPoints = 2048;  ///< traced at a time

/// Traces points, on one thread.
class PointTracer {
 public:
  PointTracer(const World::Impl& world, const Setup& setup, const RenderOptions& options)
      : world_(world),
        setup_(setup),
        options_(options),
        space_(kMostPoints, options.depth, setup.plan) {}

  void operator()(std::span<const LatticePoint> points, Float3* colours) {
    for (std::size_t first = 0; first < points.size(); first += kMostPoints)
      trace(points.subspan(first, std::min(kMostPoints, points.size() - first)), colours + first);
  }

  void count(RenderStats& stats) const {
    stats.trace += trace_;
    stats.rays += rays_;
    stats.phases += space_.phases();
  }

 private:
  void trace(std::span<const LatticePoint> points, Float3* colours) {
    for (std::size_t i = 0; i < points.size(); ++i) {  // exact: no coordinate is above 2^24
      x_[i] = static_cast<float>(points[i].x) / kLatticeSteps;
      y_[i] = static_cast<float>(points[i].y) / kLatticeSteps;
      space_.pixels()[i] = lattice_hash(points[i]);
    }
    const PointList list{x_, y_, static_cast<int>(points.size())};
    const StripWork work = space_.work(options_, 0, true);
    setup_.variant.loops.render_points(
        world_.view, setup_.shading, setup_.frame, list, work, trace_, rays_);
    const double share = 1 / (kLightUnit * setup_.plan.samples);
    const auto colour = [share](std::int64_t sum) {
      return static_cast<float>(static_cast<double>(sum) * share);
    };
    const std::int64_t* sum = space_.sums().data();
    for (std::size_t i = 0; i < points.size(); ++i, sum += 3)
      colours[i] = {colour(sum[0]), colour(sum[1]), colour(sum[2])};
    space_.done(options_);
  }

  const World::Impl& world_;
  const Setup& setup_;
  const RenderOptions& options_;
  Workspace space_;
  float x_[kMostPoints], y_[kMostPoints];
  TraceCounts trace_;
  RayCounts rays_;
};

void check(const SubdivisionState& picture, const Camera& camera, const RenderOptions& options) {
  if (!options.subdivision.on)
    throw std::invalid_argument("this picture is one by subdivision");
  if (picture.image.width != camera.width || picture.image.height != camera.height)
    throw std::invalid_argument("this picture has another size than the camera's");
  check_subdivision(options.subdivision);
}

/// Makes the tiles that are not done, until progress says to stop.
void make_tiles(const Tiles& tiles,
                const RenderOptions& options,
                GuardedProgress& progress,
                const std::vector<std::unique_ptr<PointTracer>>& tracers,
                SubdivisionState& picture) {
  const auto note = [&](std::size_t tile) {
    picture.done[tile] = 1;
    const auto done = std::count(picture.done.begin(), picture.done.end(), std::uint8_t{1});
    picture.share = static_cast<double>(done) / static_cast<double>(tiles.size());
    if (!progress.stopped())
      progress.report(picture.share);
  };
  Thrown thrown;
#pragma omp parallel for num_threads(static_cast <int>(tracers.size())) schedule(dynamic)
  for (std::size_t tile = 0; tile < tiles.size(); ++tile)
    thrown.in([&] {
      PointTracer& tracer = *tracers[static_cast<std::size_t>(omp_get_thread_num())];
      if (picture.done[tile] != 0 || progress.stopped())
        return;
      subdivide(tiles[tile], options.subdivision, std::ref(tracer), picture.image);
#pragma omp critical(grelha_progress)
      note(tile);
    });
  thrown.on();
}

}  // namespace

bool render_subdivided(const World& world,
                       const Camera& camera,
                       const RenderOptions& options,
                       SubdivisionState& picture,
                       RenderStats& stats,
                       const ShouldContinue& should_continue) {
  const Setup setup = set_up(world, camera, options);
  check(picture, camera, options);
  const Tiles tiles(picture.image, options.subdivision);
  if (picture.done.empty())
    picture.done.resize(tiles.size());
  if (picture.done.size() != tiles.size())
    throw std::invalid_argument("this picture was made in tiles of another size");
  stats = {};
  stats.threads = thread_count(options, tiles.size());
  stats.isa = setup.variant.name.data();
  GuardedProgress progress(options.progress, should_continue);
  std::vector<std::unique_ptr<PointTracer>> tracers;
  for (int i = 0; i < stats.threads; ++i)
    tracers.push_back(std::make_unique<PointTracer>(world.impl(), setup, options));
  do
    make_tiles(tiles, options, progress, tracers, picture);
  while (picture.share < 1 && progress.stopped() && progress.resume());
  for (const auto& tracer : tracers)
    tracer->count(stats);
  progress.rethrow();
  return picture.share == 1;
}

}  // namespace grelha
