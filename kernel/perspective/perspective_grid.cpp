#include "kernel/perspective/perspective_grid.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <numeric>

#include "kernel/perspective/lists.hpp"
#include "kernel/perspective/sight.hpp"

namespace grelha {
namespace {

constexpr double kMostReferencesEach = 16;  ///< a primitive, on average
constexpr double kMostExpectedEach = 64;    ///< the same, by bounds of what is seen
constexpr double kMostTilesAtAll = 0x1p22;  ///< before crowds get parts
constexpr std::uint32_t kTileCrowd = 128;   ///< primitives of a tile that is parted
constexpr double kPartCrowd = 16;           ///< primitives that each part is meant for
constexpr int kMostColumns = 16;
constexpr int kMostLevels = 4;
constexpr int kLists = 2;  ///< of a tile

/// A primitive in a list: which of all tiles' lists, and number of what is seen of the primitive.
struct Place {
  std::uint32_t list, seen;
};

class Builder {
 public:
  Builder(const Primitives& p,
          std::span<const std::uint32_t> ids,
          std::span<const std::uint32_t> large,
          const Viewpoint& from,
          const PerspectiveOptions& options)
      : p_(p),
        onlooker_(p, ids, large, from, options.loops),
        options_(options),
        primitives_(ids.size()) {
    std::copy(from.at, from.at + 3, g_.point);
  }

  PerspectiveGrid build() {
    sight_ = survey(onlooker_, options_.threads);
    g_.around = std::move(sight_.around);
    lay_tiles_for_few_references(sight_.window);
    place_all();
    part_crowds();
    write();
    return std::move(g_);
  }

 private:
  /// Lays fewer tiles where needles, or primitives that cover each other, would fill lists without
  /// bound; and no more than look-ups can number.
  void lay_tiles_for_few_references(const Window (&window)[kFaces]) {
    const double primitives = static_cast<double>(primitives_);
    double density = std::min(options_.density, kMostTilesAtAll / std::max(primitives, 1.));
    for (lay_tiles(window, density); tiles_.size() > 2 * kFaces; lay_tiles(window, density)) {
      double references = 0;
      for (int f = 0; f < kFaces; ++f)
        references += window[f].most_references(g_.face[f]);
      if (references <= kMostExpectedEach * primitives)
        return;
      density /= 4;
    }
  }

  void lay_tiles(const Window (&window)[kFaces], double density) {
    tiles_.clear();
    for (int f = 0; f < kFaces; ++f) {
      PointFace& face = g_.face[f];
      const Window& w = window[f];
      face = {};
      face.first = static_cast<double>(tiles_.size());
      face.depth = w.near < 1e300 ? w.near : 0;
      if (w.seen > 0)
        w.lay_tiles(face, density * static_cast<double>(w.seen));
      for (int y = 0; y < face.ny; ++y)
        for (int x = 0; x < face.nx; ++x)
          tiles_.push_back({
              double(x),
              double(y),
              1,
              f,
          });
      tiles_.push_back({
          0,
          0,
          0,
          f,
      });
    }
  }

  /// Adds one, and returns what was there.
  std::uint32_t next(std::uint32_t& n) const {
    if (options_.threads == 1)
      return n++;
    return std::atomic_ref(n).fetch_add(1, std::memory_order_relaxed);
  }
  std::uint32_t primitives_of(std::size_t tile) const {
    return counts_[kLists * tile] + counts_[kLists * tile + 1];
  }

  /// What a thread adds to.
  struct Writers {
    Writers(SeenPages<SeenOutline>& o, SeenPages<SeenBox>& b) : outlines(o), boxes(b) {}
    SeenPages<SeenOutline>::Writer outlines;
    SeenPages<SeenBox>::Writer boxes;
  };

  void place_all() {
    counts_.assign(kLists * tiles_.size(), 0);
    places_.resize(onlooker_.turns());
    each_turn(
        places_.size(),
        options_.threads,
        [&] { return Writers(outlines_, boxes_); },
        [&](std::size_t turn, Writers& writers) {
          places_[turn].reserve(4 * Onlooker::kTurn);
          place_turn(turn, writers);
          for (const Place& at : places_[turn])
            next(counts_[at.list]);
        });
  }

  /// Primitives that are seen through one face, until there are enough to be looked at together.
  struct Waiting {
    Few few;
    float distance[kOutlines] = {};
    void add(std::uint32_t id, float far) {
      distance[few.count] = far;
      few.id[few.count++] = id;
    }
  };

  void place_turn(std::size_t turn, Writers& writers) {
    Waiting waiting[kFaces];
    const auto place_waiting = [&](int f) {
      if (waiting[f].few.count > 0)
        place_few(waiting[f], f, writers, places_[turn]);
      waiting[f].few.count = 0;
    };
    PrimitiveKind kind = PrimitiveKind::kPlane;  // of none yet
    for (std::size_t i = onlooker_.begin(turn); i < onlooker_.end(turn); ++i) {
      const std::uint32_t id = onlooker_.id(i);
      if (!p_.ids.has(kind, id)) {
        for (int f = 0; f < kFaces; ++f)
          place_waiting(f);
        kind = p_.kind_of(id);
      }
      for (unsigned left = sight_.glances[i].faces; left != 0; left &= left - 1) {
        const int f = std::countr_zero(left);
        waiting[f].add(id, sight_.glances[i].distance);
        if (waiting[f].few.count == kOutlines)
          place_waiting(f);
      }
    }
    for (int f = 0; f < kFaces; ++f)
      place_waiting(f);
  }

  /// What is seen of some through a face.
  void place_few(const Waiting& of, int f, Writers& writers, std::vector<Place>& to) const {
    SeenFew seen;
    onlooker_.see(of.few, of.distance, f, g_.face[f], seen);
    for (unsigned left = seen.seen; left != 0; left &= left - 1) {
      const int k = std::countr_zero(left);
      const std::uint32_t id = of.few.id[k];
      if (seen.sided)
        place(seen, k, id, f, kOutlineList, writers.outlines.add(seen, k, id), to);
      else
        place(seen, k, id, f, kBoxList, writers.boxes.add(seen, k, id), to);
    }
  }

  /// The tiles of its face that a primitive may be met in.
  void place(const SeenFew& seen,
             int k,
             std::uint32_t id,
             int f,
             std::uint32_t kind,
             std::uint32_t number,
             std::vector<Place>& to) const {
    const PointFace& face = g_.face[f];
    const auto first = static_cast<std::uint32_t>(face.first);
    const int columns = static_cast<int>(face.nx);
    const int rows = static_cast<int>(face.ny);
    const auto beyond = static_cast<std::uint32_t>(columns * rows);
    if (onlooker_.is_large(id))
      to.push_back({kLists * (first + beyond) + kind, number});
    if (beyond == 0 || !(seen.on_tiles >> k & 1))
      return;
    const auto add = [&](std::uint32_t tile) {
      to.push_back({kLists * (first + tile) + kind, number});
    };
    if (seen.sided && seen.anchor[1][k] != seen.last[1][k])
      TileWalk({0, 0, 1, columns, rows}).each(seen, k, add);
    else
      each_in_box(seen, k, columns, add);
  }

  /// The tiles of a face that the bounds of primitive k touch.
  template <class Visit>
  static void each_in_box(const SeenFew& seen, int k, int columns, const Visit& visit) {
    const int end = static_cast<int>(seen.last[0][k]) + 1;
    for (int y = static_cast<int>(seen.anchor[1][k]); y <= static_cast<int>(seen.last[1][k]); ++y)
      for (int x = static_cast<int>(seen.anchor[0][k]); x < end; ++x)
        visit(static_cast<std::uint32_t>(y * columns + x));
  }

  /// Tiles with too many primitives get parts, and these again.
  void part_crowds() {
    g_.tiles.resize(tiles_.size());
    double references = std::accumulate(counts_.begin(), counts_.end(), 0.);
    const double most = kMostReferencesEach * static_cast<double>(primitives_);
    std::size_t begin = 0;
    for (int level = 0; level < kMostLevels && references < most; ++level) {
      const std::size_t end = tiles_.size();
      for (std::size_t t = begin; t < end; ++t)
        if (primitives_of(t) > kTileCrowd && tiles_[t].width > 0)
          part(t);
      begin = end;
      if (tiles_.size() == end)
        return;
      g_.tiles.resize(tiles_.size());
      counts_.resize(kLists * tiles_.size());
      each_turn(places_.size(), options_.threads, [&](std::size_t turn) { place_parts(turn); });
      references = 0;
      for (std::size_t t = end; t < tiles_.size(); ++t)
        references += primitives_of(t);
    }
  }

  void part(std::size_t t) {
    const int columns = static_cast<int>(
        std::clamp(std::ceil(std::sqrt(primitives_of(t) / kPartCrowd)), 2., double{kMostColumns}));
    g_.tiles[t].part = static_cast<std::uint32_t>(tiles_.size());
    g_.tiles[t].columns = static_cast<std::uint32_t>(columns);
    const Tile whole = tiles_[t];
    const double width = whole.width / columns;
    for (int y = 0; y < columns; ++y)
      for (int x = 0; x < columns; ++x)
        tiles_.push_back({
            whole.x + x * width,
            whole.y + y * width,
            width,
            whole.face,
        });
    counts_[kLists * t] = 0;
    counts_[kLists * t + 1] = 0;
  }

  /// Places in tiles with parts, of primitives that are looked at again together.
  struct Crowd {
    Waiting of;
    PrimitiveKind kind = PrimitiveKind::kPlane;  ///< of nothing yet
    int face = 0;
    std::vector<Place> places;
    std::vector<int> which;  ///< [places] of those that are looked at
    bool is_of_last(const Place& p) const {
      return !places.empty() && places.back().seen == p.seen &&
             places.back().list % kLists == p.list % kLists;
    }
    void add(const Place& p) {
      places.push_back(p);
      which.push_back(of.few.count - 1);
    }
  };

  /// Takes what is placed in tiles with parts to these.
  void place_parts(std::size_t turn) {
    std::vector<Place>& places = places_[turn];
    const auto in_parts = [&](const Place& p) { return g_.tiles[p.list / kLists].columns > 0; };
    auto kept = std::find_if(places.begin(), places.end(), in_parts);
    Crowd crowd;
    std::vector<Place> placed;
    for (auto at = kept; at != places.end(); ++at)
      if (in_parts(*at))
        add(*at, crowd, placed);
      else
        *kept++ = *at;
    place_crowd(crowd, placed);
    places.erase(kept, places.end());
    places.insert(places.end(), placed.begin(), placed.end());
  }

  /// Adds a place, and before it ends what cannot take its primitive.
  void add(const Place& p, Crowd& crowd, std::vector<Place>& to) {
    const int f = tiles_[p.list / kLists].face;
    if (f == crowd.face && crowd.is_of_last(p))
      return crowd.add(p);
    const std::uint32_t id = p.list % kLists == kBoxList ? boxes_[p.seen].id : outlines_[p.seen].id;
    const bool fits = f == crowd.face && p_.ids.has(crowd.kind, id);
    if (!fits || crowd.of.few.count == kOutlines) {
      place_crowd(crowd, to);
      crowd = {{}, p_.kind_of(id), f, {}, {}};
    }
    crowd.of.add(id, sight_.glances[onlooker_.place_of(id)].distance);
    crowd.add(p);
  }

  /// Outlines are kept as lists hold them; the few that are asked for again are made again.
  void place_crowd(const Crowd& crowd, std::vector<Place>& to) {
    if (crowd.places.empty())
      return;
    SeenFew seen;
    onlooker_.see(crowd.of.few, crowd.of.distance, crowd.face, g_.face[crowd.face], seen);
    for (std::size_t i = 0; i < crowd.places.size(); ++i) {
      const Place& p = crowd.places[i];
      const std::uint32_t tile = p.list / kLists;
      const Tile& t = tiles_[tile];
      const int n = static_cast<int>(g_.tiles[tile].columns);
      TileWalk({t.x, t.y, t.width / n, n, n}).each(seen, crowd.which[i], [&](std::uint32_t part) {
        to.push_back({kLists * (g_.tiles[tile].part + part) + p.list % kLists, p.seen});
        next(counts_[to.back().list]);
      });
    }
  }

  /// Sets where the lists of a kind begin, from counts; which become the next free place of each
  /// list in all references, of which `before` come first. Returns how many there are.
  std::uint32_t begin_lists(int kind, std::uint32_t before) {
    std::uint32_t first = 0;
    for (std::size_t t = 0; t < tiles_.size(); ++t) {
      std::uint32_t& n = counts_[kLists * t + static_cast<std::size_t>(kind)];
      g_.tiles[t].first[kind] = first;
      first += n;
      n = before + first - n;
    }
    g_.tiles.back().first[kind] = first;
    return first;
  }

  void write() {
    g_.tiles.resize(tiles_.size() + 1);
    const std::uint32_t outlines = begin_lists(kOutlineList, 0);
    const std::uint32_t boxes = begin_lists(kBoxList, outlines);
    references_.resize(outlines + boxes);
    each_turn(places_.size(), options_.threads, [&](std::size_t turn) {
      for (const Place& p : places_[turn])
        references_[next(counts_[p.list])] = p.seen;
    });
    g_.outlines.resize(outlines / kOutlines + 1);
    g_.boxes.resize(boxes / kOutlines + 1);
    const std::span<const std::uint32_t> all(references_.data(), references_.size());
    write_lists<SeenOutline>({kOutlineList, tiles_, g_.tiles, all.first(outlines), outlines_},
                             options_.loops,
                             options_.threads,
                             g_.outlines.data());
    write_lists<SeenBox>({kBoxList, tiles_, g_.tiles, all.subspan(outlines), boxes_},
                         options_.loops,
                         options_.threads,
                         g_.boxes.data());
  }

  const Primitives& p_;
  const Onlooker onlooker_;
  const PerspectiveOptions& options_;
  const std::size_t primitives_;
  PerspectiveGrid g_;
  Sight sight_;
  SeenPages<SeenOutline> outlines_;
  SeenPages<SeenBox> boxes_;
  std::vector<Tile> tiles_;
  std::vector<std::uint32_t> counts_;       ///< [lists of all tiles] what stands in each
  std::vector<std::vector<Place>> places_;  ///< [turns]
  RawVector<std::uint32_t> references_;     ///< what is seen, list after list
};

}  // namespace

PerspectiveGrid build_perspective_grid(const Primitives& primitives,
                                       std::span<const std::uint32_t> ids,
                                       std::span<const std::uint32_t> large,
                                       const Viewpoint& from,
                                       const PerspectiveOptions& options) {
  return Builder(primitives, ids, large, from, options).build();
}

PointGridView PerspectiveGrid::view() const {
  PointGridView v;
  std::copy(point, point + 3, v.point);
  std::copy(face, face + kFaces, v.face);
  v.tiles = tiles.data();
  v.outlines = outlines.data();
  v.boxes = boxes.data();
  v.around = around.data();
  v.around_count = static_cast<std::uint32_t>(around.size());
  return v;
}

std::size_t PerspectiveGrid::references() const {
  return std::size_t{tiles.back().first[kOutlineList]} + tiles.back().first[kBoxList];
}

std::size_t PerspectiveGrid::bytes() const {
  return bytes_of(tiles) + bytes_of(outlines) + bytes_of(boxes) + bytes_of(around);
}

}  // namespace grelha
