#include "kernel/picture/subdivided.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

namespace grelha {
namespace {

/// Bits of x at every other place.
std::uint64_t spread(std::uint64_t x) {
  x = (x | x << 16) & 0x0000FFFF0000FFFFu;
  x = (x | x << 8) & 0x00FF00FF00FF00FFu;
  x = (x | x << 4) & 0x0F0F0F0F0F0F0F0Fu;
  x = (x | x << 2) & 0x3333333333333333u;
  return (x | x << 1) & 0x5555555555555555u;
}

/// Place on Morton's curve: points sorted by it are neighbours, for the packets' sake.
std::uint64_t morton(LatticePoint p) { return spread(p.x) | spread(p.y) << 1; }

/// A point on a border of the tile, and where in its colours that stands.
struct Border {
  std::uint64_t key;
  std::uint32_t id;
};

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

float clamped(float x) { return x < 0 ? 0.f : x > 1 ? 1.f : x; }

struct Sum {
  double r = 0, g = 0, b = 0;
  void add(const Float3 (&c)[4], double share) {
    r += share * ((static_cast<double>(c[0].x) + c[1].x) + (static_cast<double>(c[2].x) + c[3].x));
    g += share * ((static_cast<double>(c[0].y) + c[1].y) + (static_cast<double>(c[2].y) + c[3].y));
    b += share * ((static_cast<double>(c[0].z) + c[1].z) + (static_cast<double>(c[2].z) + c[3].z));
  }
};

class Subdivider {
 public:
  Subdivider(Subdivided& picture,
             const Subdivision& options,
             const SeePoints& see,
             int tile,
             const std::function<bool()>& rest)
      : options_(options),
        see_(see),
        rest_(rest),
        side_(tile),
        p_(picture),
        image_(picture.image) {}

  bool run() {
    const auto tiles = [this](int side) {
      return static_cast<std::size_t>((side - 1) / side_ + 1);
    };
    const std::size_t rows = tiles(image_.height), columns = tiles(image_.width);
    if (p_.tiles == 0)
      p_.above.resize(columns);
    if (p_.above.size() != columns || p_.tiles > rows * columns)
      throw std::invalid_argument("this picture was made in tiles of another size");
    for (part_ = 1 / static_cast<double>(rows * columns); p_.tiles < rows * columns; ++p_.tiles) {
      const std::size_t column = p_.tiles % columns;
      if (column == 0)
        p_.left.clear();
      done_ = static_cast<double>(p_.tiles) * part_;
      if (!tile(static_cast<int>(column), static_cast<int>(p_.tiles / columns), p_.above[column]))
        return false;
    }
    p_.share = 1;
    return true;
  }

 private:
  bool tile(int column, int row, std::vector<BorderPoint>& above) {
    x0_ = column * side_;
    y0_ = row * side_;
    x1_ = std::min(x0_ + side_, image_.width);
    y1_ = std::min(y0_ + side_, image_.height);
    recall(above, p_.left);
    sums_.assign(static_cast<std::size_t>(x1_ - x0_) * static_cast<std::size_t>(y1_ - y0_), {});
    split_.clear();
    if (!corners())
      return false;
    for (int level = 0; level < options_.depth && !split_.empty(); ++level)
      if (!split_all(level))
        return false;
    show(sums_);
    remember(right_border_, p_.left);
    remember(lower_border_, above);
    p_.colours.clear();
    return true;
  }

  /// Points that tiles above and to the left saw on the borders with this one come first: the
  /// number of one is its place.
  void recall(const std::vector<BorderPoint>& above, const std::vector<BorderPoint>& left) {
    known_.clear();
    fresh_.clear();
    right_border_.clear();
    lower_border_.clear();
    std::set_union(above.begin(),
                   above.end(),
                   left.begin(),
                   left.end(),
                   std::back_inserter(known_),
                   [](const BorderPoint& a, const BorderPoint& b) { return a.key < b.key; });
    numbered_ = known_.size();
    if (p_.colours.size() >= numbered_)
      return;  // those of a tile to go on with
    p_.colours.clear();
    for (const BorderPoint& k : known_)
      p_.colours.push_back(k.colour);
  }

  /// The number of a point not asked for in this tile before.
  std::uint32_t number(LatticePoint p, std::uint64_t key) {
    std::uint32_t id = 0;
    bool known = false;
    if (p.x == static_cast<std::uint32_t>(x0_) * kLatticeSteps ||
        p.y == static_cast<std::uint32_t>(y0_) * kLatticeSteps) {
      const auto at = std::lower_bound(
          known_.begin(), known_.end(), key, [](const BorderPoint& a, std::uint64_t k) {
            return a.key < k;
          });
      known = at != known_.end() && at->key == key;
      if (known)
        id = static_cast<std::uint32_t>(at - known_.begin());
    }
    if (!known) {
      id = static_cast<std::uint32_t>(numbered_ + fresh_.size());
      fresh_.push_back(p);
    }
    if (p.x == static_cast<std::uint32_t>(x1_) * kLatticeSteps)
      right_border_.push_back({key, id});
    if (p.y == static_cast<std::uint32_t>(y1_) * kLatticeSteps)
      lower_border_.push_back({key, id});
    return id;
  }

  /// Shares of a tile's work by level, halved from level to level: nobody knows beforehand how much
  /// is to come.
  double share(int level) const {
    return done_ + part_ * (level > options_.depth ? 1 : 1 - std::ldexp(1, -level));
  }

  /// Whether all fresh points have their colours then. Of a tile gone on with they may have them
  /// already, or the first of them.
  bool see_fresh(int level) {
    const std::size_t end = numbered_ + fresh_.size();
    const auto share_at = [&](std::size_t seen) {
      return share(level) + (share(level + 1) - share(level)) *
                                static_cast<double>(seen - numbered_) /
                                static_cast<double>(fresh_.size());
    };
    for (std::size_t begin; (begin = p_.colours.size()) < end;) {
      p_.colours.resize(end);
      const std::size_t seen = begin + see_(std::span(fresh_).subspan(begin - numbered_),
                                            p_.colours.data() + begin,
                                            share_at(begin),
                                            share_at(end));
      p_.colours.resize(seen);
      p_.share = std::min(1.0, share_at(seen));
      if (seen == end)
        break;
      if (level == 0)
        show_corners();
      else
        show_squares(level - 1);
      if (!rest_ || !rest_())
        return false;
    }
    numbered_ = end;
    fresh_.clear();
    return true;
  }

  /// Level 0, in blocks of 8 x 8 points; then every pixel is a square.
  bool corners() {
    const int across = x1_ - x0_ + 1, down = y1_ - y0_ + 1;
    ids_.resize(static_cast<std::size_t>(across) * static_cast<std::size_t>(down));
    for (int by = 0; by < down; by += 8)
      for (int bx = 0; bx < across; bx += 8)
        for (int y = by; y < std::min(by + 8, down); ++y)
          for (int x = bx; x < std::min(bx + 8, across); ++x) {
            const LatticePoint p = corner_at(x, y);
            ids_[static_cast<std::size_t>(y) * static_cast<std::size_t>(across) +
                 static_cast<std::size_t>(x)] = number(p, morton(p));
          }
    if (!see_fresh(0))
      return false;
    std::uint32_t pixel = 0;
    for (int y = 0; y + 1 < down; ++y)
      for (int x = 0; x + 1 < across; ++x, ++pixel) {
        const std::uint32_t* const upper =
            ids_.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(across) + x;
        settle({corner_at(x, y), pixel, {upper[0], upper[1], upper[across], upper[across + 1]}},
               0,
               split_);
      }
    return true;
  }

  LatticePoint corner_at(int x, int y) const {
    return {static_cast<std::uint32_t>(x0_ + x) * kLatticeSteps,
            static_cast<std::uint32_t>(y0_ + y) * kLatticeSteps};
  }

  /// Splits the squares of `level` that wait for it. Their new points are corners of no square but
  /// those split now: a point is born on the one level whose step it is an odd multiple of.
  bool split_all(int level) {
    const std::uint32_t half = kLatticeSteps >> (level + 1);
    const LatticePoint offset[5] = {
        {half, 0}, {0, half}, {half, half}, {2 * half, half}, {half, 2 * half}};
    wanted_.resize(5 * split_.size()), ids_.resize(wanted_.size());
    const auto point = [&](std::size_t slot) {
      const LatticePoint at = split_[slot / 5].at, by = offset[slot % 5];
      return LatticePoint{at.x + by.x, at.y + by.y};
    };
    for (std::size_t i = 0; i < wanted_.size(); ++i)
      wanted_[i] = {morton(point(i)), static_cast<std::uint32_t>(i)};
    std::sort(wanted_.begin(), wanted_.end(), [](const Wanted& a, const Wanted& b) {
      return a.key < b.key;
    });
    std::uint32_t id = 0;
    for (std::size_t i = 0; i < wanted_.size(); ++i) {
      if (i == 0 || wanted_[i].key != wanted_[i - 1].key)
        id = number(point(wanted_[i].slot), wanted_[i].key);
      ids_[wanted_[i].slot] = id;
    }
    if (!see_fresh(level + 1))
      return false;
    next_.clear();
    for (std::size_t i = 0; i < split_.size(); ++i) {
      const auto& [at, pixel, c] = split_[i];
      const std::uint32_t* const n = ids_.data() + 5 * i;
      settle({at, pixel, {c[0], n[0], n[1], n[2]}}, level + 1, next_);
      settle({{at.x + half, at.y}, pixel, {n[0], c[1], n[2], n[3]}}, level + 1, next_);
      settle({{at.x, at.y + half}, pixel, {n[1], n[2], c[2], n[4]}}, level + 1, next_);
      settle({{at.x + half, at.y + half}, pixel, {n[2], n[3], n[4], c[3]}}, level + 1, next_);
    }
    split_.swap(next_);
    return true;
  }

  /// A square whose corners are known joins those to be split, or its pixel's sum. The order of a
  /// pixel's terms is that of its own squares alone.
  void settle(const Square& s, int level, std::vector<Square>& to_split) {
    const Float3 c[4] = {p_.colours[s.corner[0]],
                         p_.colours[s.corner[1]],
                         p_.colours[s.corner[2]],
                         p_.colours[s.corner[3]]};
    if (level < options_.depth &&
        (differ(c, &Float3::x) || differ(c, &Float3::y) || differ(c, &Float3::z)))
      to_split.push_back(s);
    else
      sums_[s.pixel].add(c, std::ldexp(.25, -2 * level));
  }

  bool differ(const Float3 (&c)[4], float Float3::*channel) const {
    const auto [least, most] = std::minmax({clamped(c[0].*channel),
                                            clamped(c[1].*channel),
                                            clamped(c[2].*channel),
                                            clamped(c[3].*channel)});
    return most - least > options_.threshold;
  }

  void show(const std::vector<Sum>& sums) {
    const Sum* sum = sums.data();
    for (int y = y0_; y < y1_; ++y) {
      float* out = image_.row(y) + 3 * static_cast<std::size_t>(x0_);
      for (int x = x0_; x < x1_; ++x, ++sum, out += 3) {
        out[0] = static_cast<float>(sum->r);
        out[1] = static_cast<float>(sum->g);
        out[2] = static_cast<float>(sum->b);
      }
    }
  }

  /// Of a tile that is stopped: until all corners are seen a pixel is its first one.
  void show_corners() {
    const std::size_t width = static_cast<std::size_t>(x1_ - x0_);
    std::vector<Sum> sums(sums_.size());
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const std::uint32_t id = ids_[i + i / width];  // a row has one corner more than pixels
      if (id >= p_.colours.size())
        continue;
      const Float3 c = p_.colours[id];
      sums[i].add({c, c, c, c}, .25);
    }
    show(sums);
  }
  /// Squares that wait to be split are what their corners are.
  void show_squares(int level) {
    std::vector<Sum> sums = sums_;
    for (const auto& [at, pixel, n] : split_)
      sums[pixel].add({p_.colours[n[0]], p_.colours[n[1]], p_.colours[n[2]], p_.colours[n[3]]},
                      std::ldexp(.25, -2 * level));
    show(sums);
  }

  void remember(std::vector<Border>& border, std::vector<BorderPoint>& seen) {
    std::sort(border.begin(), border.end(), [](const Border& a, const Border& b) {
      return a.key < b.key;
    });
    seen.clear();
    for (const Border& b : border)
      seen.push_back({b.key, p_.colours[b.id]});
  }

  const Subdivision& options_;
  const SeePoints& see_;
  const std::function<bool()>& rest_;
  const int side_;
  Subdivided& p_;
  Image& image_;
  // the tile in work
  int x0_ = 0, y0_ = 0, x1_ = 0, y1_ = 0;
  double done_ = 0, part_ = 1;
  std::vector<BorderPoint> known_;
  std::size_t numbered_ = 0;         ///< points before the fresh ones
  std::vector<LatticePoint> fresh_;  ///< asked for last
  std::vector<Border> right_border_, lower_border_;
  std::vector<std::uint32_t> ids_;
  std::vector<Square> split_, next_;
  std::vector<Wanted> wanted_;
  std::vector<Sum> sums_;
};

}  // namespace

Subdivided make_subdivided(int width, int height) {
  if (width < 1 || height < 1 || width > kMostSubdividedSide || height > kMostSubdividedSide)
    throw std::invalid_argument("a subdivided picture has sides from 1 to " +
                                std::to_string(kMostSubdividedSide));
  return {Image(width, height), 0, {}, {}, {}, 0};
}

bool is_sound(const Subdivided& s) {
  const auto ascends = [](const std::vector<BorderPoint>& border) {
    const auto falls = [](const BorderPoint& a, const BorderPoint& b) { return a.key >= b.key; };
    return std::adjacent_find(border.begin(), border.end(), falls) == border.end();
  };
  const int most = std::max(s.image.width, s.image.height),
            least = std::min(s.image.width, s.image.height);
  if (least < 1 || most > kMostSubdividedSide || !(s.share >= 0) || s.share > 1)
    return false;
  return ascends(s.left) && std::all_of(s.above.begin(), s.above.end(), ascends);
}

bool subdivide(Subdivided& picture,
               const Subdivision& options,
               const SeePoints& see,
               int tile,
               const std::function<bool()>& rest) {
  if (!(options.threshold >= 0) || options.threshold > 1)
    throw std::invalid_argument("the threshold of subdivision must be from 0 to 1");
  if (options.depth < 0 || options.depth > kMostSubdivisions)
    throw std::invalid_argument("the depth of subdivision must be from 0 to " +
                                std::to_string(kMostSubdivisions));
  if (tile <= 0)
    tile = std::min(1024, 4096 >> options.depth);
  return Subdivider(picture, options, see, tile, rest).run();
}

}  // namespace grelha
