#include "kernel/subdivision/subdivider.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "kernel/subdivision/tile_points.hpp"
#include "kernel/subdivision/tile_sums.hpp"

namespace grelha {
namespace {

constexpr int kBlock = 8;  ///< points a side, of those numbered together on level 0

struct Square {
  LatticePoint at;          ///< upper left corner
  std::uint32_t pixel;      ///< of the tile
  std::uint32_t corner[4];  ///< into the tile's colours, by rows
};

/// One of the five new points of a split square: 5 square + {above, left, centre, right, below}.
struct Wanted {
  std::uint64_t key;
  std::uint32_t slot;
};

float clamped(float x) {
  return x < 0 ? 0.f : x > 1 ? 1.f : x;
}

/// Whether a channel of two corners differs by more than the threshold.
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

/// How far the picture is when a tile comes to a level. Shares of a tile's work are halved from
/// level to level: nobody knows beforehand how much is to come.
struct TileShare {
  double before;  ///< of the picture, done before the tile
  double part;    ///< of the picture that the tile is
  int depth;
  double at(int level) const {
    return before + part * (level > depth ? 1 : 1 - std::ldexp(1, -level));
  }
};

/// Goes on with one tile.
class TileSubdivider {
 public:
  TileSubdivider(SubdivisionState& picture,
                 const Subdivision& options,
                 const TracePoints& trace,
                 const ShouldContinue& should_continue,
                 const TileRect& rect,
                 const TileShare& share)
      : picture_(picture),
        options_(options),
        trace_(trace),
        should_continue_(should_continue),
        rect_(rect),
        share_(share),
        sums_(rect) {}

  /// Whether the tile is finished. `above`: of its column.
  bool run(std::vector<BorderPoint>& above) {
    points_.load_border(rect_, above, picture_.left, picture_.colours);
    if (!trace_corners())
      return false;
    for (int level = 0; level < options_.depth && !split_.empty(); ++level)
      if (!split_all(level))
        return false;
    sums_.show(picture_.image);
    points_.store_border(picture_.colours, above, picture_.left);
    picture_.colours.clear();
    return true;
  }

 private:
  /// Level 0, in blocks of points; then every pixel is a square.
  bool trace_corners() {
    number_corners();
    if (!trace_fresh(0))
      return false;
    std::uint32_t pixel = 0;
    for (int y = 0; y + 1 < down(); ++y)
      for (int x = 0; x + 1 < across(); ++x, ++pixel) {
        const std::uint32_t* const upper = &id_at(x, y);
        const std::uint32_t* const lower = &id_at(x, y + 1);
        resolve({corner_at(x, y), pixel, {upper[0], upper[1], lower[0], lower[1]}}, 0, split_);
      }
    return true;
  }

  /// Corners of pixels a row, and a column.
  int across() const { return rect_.x1 - rect_.x0 + 1; }
  int down() const { return rect_.y1 - rect_.y0 + 1; }

  std::uint32_t& id_at(int x, int y) {
    return ids_[static_cast<std::size_t>(y) * static_cast<std::size_t>(across()) +
                static_cast<std::size_t>(x)];
  }

  void number_corners() {
    ids_.resize(static_cast<std::size_t>(across()) * static_cast<std::size_t>(down()));
    for (int y = 0; y < down(); y += kBlock)
      for (int x = 0; x < across(); x += kBlock)
        number_block(x, y);
  }

  /// Numbers kBlock x kBlock corners, those of them that the tile has.
  void number_block(int x0, int y0) {
    const int x1 = std::min(x0 + kBlock, across());
    const int y1 = std::min(y0 + kBlock, down());
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) {
        const LatticePoint p = corner_at(x, y);
        id_at(x, y) = points_.number(p, morton(p));
      }
  }

  LatticePoint corner_at(int x, int y) const {
    return {static_cast<std::uint32_t>(rect_.x0 + x) * kLatticeSteps,
            static_cast<std::uint32_t>(rect_.y0 + y) * kLatticeSteps};
  }

  /// Splits the squares of `level` that wait for it.
  bool split_all(int level) {
    const std::uint32_t half = kLatticeSteps >> (level + 1);
    number_new_points(half);
    if (!trace_fresh(level + 1))
      return false;
    next_.clear();
    for (std::size_t i = 0; i < split_.size(); ++i)
      for (const Square& quarter : quarters(split_[i], half, ids_.data() + 5 * i))
        resolve(quarter, level + 1, next_);
    split_.swap(next_);
    return true;
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
    wanted_.resize(5 * split_.size());
    ids_.resize(wanted_.size());
    for (std::size_t i = 0; i < wanted_.size(); ++i)
      wanted_[i] = {morton(new_point(i, half)), static_cast<std::uint32_t>(i)};
    std::sort(wanted_.begin(), wanted_.end(), [](const Wanted& a, const Wanted& b) {
      return a.key < b.key;
    });
    std::uint32_t id = 0;
    for (std::size_t i = 0; i < wanted_.size(); ++i) {
      const auto& [key, slot] = wanted_[i];
      if (i == 0 || key != wanted_[i - 1].key)
        id = points_.number(new_point(slot, half), key);
      ids_[slot] = id;
    }
  }

  /// The point of a slot, see Wanted; `half`: of the sides of the squares.
  LatticePoint new_point(std::size_t slot, std::uint32_t half) const {
    constexpr LatticePoint kHalves[5] = {{1, 0}, {0, 1}, {1, 1}, {2, 1}, {1, 2}};
    const LatticePoint at = split_[slot / 5].at;
    const LatticePoint by = kHalves[slot % 5];
    return {at.x + by.x * half, at.y + by.y * half};
  }

  /// Traces the points that have no colours yet. Returns whether all have them then. A tile that
  /// is gone on with may bring all colours along, or the first of them.
  bool trace_fresh(int level) {
    const std::size_t end = points_.first_fresh() + points_.fresh().size();
    while (picture_.colours.size() < end) {
      if (trace_some(level) == end)
        break;
      if (level == 0)
        show_corners();
      else
        show_squares(level - 1);
      if (!should_continue_ || !should_continue_())
        return false;
    }
    points_.accept_fresh();
    return true;
  }

  /// Traces points that have no colours yet, until progress says to stop. Returns how many points
  /// of the tile have colours then.
  std::size_t trace_some(int level) {
    std::vector<Float3>& colours = picture_.colours;
    const std::size_t begin = colours.size();
    const std::size_t first = points_.first_fresh();
    const std::span<const LatticePoint> fresh = points_.fresh();
    const double before = share_.at(level);
    const auto share_at = [&](std::size_t traced) {
      return before + (share_.at(level + 1) - before) * static_cast<double>(traced - first) /
                          static_cast<double>(fresh.size());
    };
    const std::size_t end = first + fresh.size();
    colours.resize(end);
    const std::size_t traced = begin + trace_(fresh.subspan(begin - first),
                                              colours.data() + begin,
                                              share_at(begin),
                                              share_at(end));
    colours.resize(traced);
    picture_.share = std::min(1.0, share_at(traced));
    return traced;
  }

  /// A square whose corners are known joins those to be split, or its pixel's sum. The order of a
  /// pixel's terms is that of its own squares alone.
  void resolve(const Square& s, int level, std::vector<Square>& to_split) {
    const std::vector<Float3>& colours = picture_.colours;
    const Float3 c[4] = {
        colours[s.corner[0]], colours[s.corner[1]], colours[s.corner[2]], colours[s.corner[3]]};
    if (level < options_.depth && differ(c, options_.threshold))
      to_split.push_back(s);
    else
      sums_.add(s.pixel, c, level);
  }

  /// Shows a tile that is stopped on level 0: until all corners are seen a pixel is its first one.
  void show_corners() {
    TileSums sums(rect_);
    for (std::size_t i = 0; i < sums.size(); ++i) {
      // a row has one corner more than pixels
      const std::uint32_t id = ids_[i + i / sums.width()];
      if (id >= picture_.colours.size())
        continue;
      const Float3 c = picture_.colours[id];
      sums.add(static_cast<std::uint32_t>(i), {c, c, c, c}, 0);
    }
    sums.show(picture_.image);
  }

  /// Shows a tile that is stopped later: squares that wait to be split are what their corners are.
  void show_squares(int level) {
    const std::vector<Float3>& colours = picture_.colours;
    TileSums sums = sums_;
    for (const auto& [at, pixel, n] : split_)
      sums.add(pixel, {colours[n[0]], colours[n[1]], colours[n[2]], colours[n[3]]}, level);
    sums.show(picture_.image);
  }

  SubdivisionState& picture_;
  const Subdivision& options_;
  const TracePoints& trace_;
  const ShouldContinue& should_continue_;
  const TileRect rect_;
  const TileShare share_;
  TileSums sums_;
  TilePoints points_;
  std::vector<std::uint32_t> ids_;  ///< of corners by rows, or of new points by slot
  std::vector<Square> split_, next_;
  std::vector<Wanted> wanted_;
};

/// Tiles of a picture, by rows.
struct Tiling {
  Tiling(const Image& image, int a_side)
      : side(a_side), rows(tiles_of(image.height)), columns(tiles_of(image.width)) {}

  std::size_t tiles_of(int pixels) const {
    return static_cast<std::size_t>((pixels - 1) / side + 1);
  }
  std::size_t size() const { return rows * columns; }
  TileRect rect(std::size_t tile, const Image& image) const {
    TileRect r;
    r.x0 = static_cast<int>(tile % columns) * side;
    r.y0 = static_cast<int>(tile / columns) * side;
    r.x1 = std::min(r.x0 + side, image.width);
    r.y1 = std::min(r.y0 + side, image.height);
    return r;
  }

  int side;
  std::size_t rows, columns;
};

/// Goes through the tiles that are not finished.
bool subdivide_tiles(SubdivisionState& picture,
                     const Subdivision& options,
                     const TracePoints& trace,
                     int side,
                     const ShouldContinue& should_continue) {
  const Tiling tiles(picture.image, side);
  if (picture.tiles == 0)
    picture.above.resize(tiles.columns);
  if (picture.above.size() != tiles.columns || picture.tiles > tiles.size())
    throw std::invalid_argument("this picture was made in tiles of another size");
  const double part = 1 / static_cast<double>(tiles.size());
  for (; picture.tiles < tiles.size(); ++picture.tiles) {
    const std::size_t column = picture.tiles % tiles.columns;
    if (column == 0)
      picture.left.clear();
    const TileShare share{static_cast<double>(picture.tiles) * part, part, options.depth};
    const TileRect rect = tiles.rect(picture.tiles, picture.image);
    TileSubdivider tile(picture, options, trace, should_continue, rect, share);
    if (!tile.run(picture.above[column]))
      return false;
  }
  picture.share = 1;
  return true;
}

}  // namespace

bool subdivide(SubdivisionState& picture,
               const Subdivision& options,
               const TracePoints& trace,
               int tile,
               const ShouldContinue& should_continue) {
  if (!(options.threshold >= 0) || options.threshold > 1)
    throw std::invalid_argument("the threshold of subdivision must be from 0 to 1");
  if (options.depth < 0 || options.depth > kMostSubdivisions)
    throw std::invalid_argument("the depth of subdivision must be from 0 to " +
                                std::to_string(kMostSubdivisions));
  if (tile <= 0)
    tile = std::min(1024, 4096 >> options.depth);
  return subdivide_tiles(picture, options, trace, tile, should_continue);
}

}  // namespace grelha
