#include "kernel/perspective/perspective_grid.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>

#include "kernel/perspective/sight.hpp"
#include "kernel/perspective/thrown.hpp"

namespace grelha {
namespace {

constexpr double kMostReferencesEach = 16;  ///< a primitive, on average
constexpr double kMostExpectedEach = 64;    ///< the same, by boxes around what is seen
constexpr double kMostTilesAtAll = 0x1p22;  ///< before crowds get parts
constexpr std::uint32_t kTileCrowd = 128;   ///< primitives of a tile that is parted
constexpr double kPartCrowd = 16;           ///< primitives that each part is meant for
constexpr int kMostColumns = 16;
constexpr int kMostLevels = 4;

/// A primitive in a list: number of what is seen of it.
struct Place {
  std::uint32_t tile, seen;
};

/// The same in order: by depth, then by id.
struct Reference {
  std::uint64_t order;
  std::uint32_t seen;
  bool operator<(const Reference& o) const { return order < o.order; }
};

/// Floats as numbers in the same order.
std::uint32_t ordered(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x);
  return bits >> 31 ? ~bits : bits | 0x80000000u;
}

Reference reference(const Seen& s, std::uint32_t seen) {
  return {std::uint64_t{ordered(least_depth(s))} << 32 | s.id, seen};
}

class Builder {
 public:
  Builder(const Primitives& p,
          std::span<const std::uint32_t> ids,
          std::span<const std::uint32_t> large,
          const Viewpoint& from,
          const PerspectiveOptions& options)
      : p_(p), ids_(ids), large_(large), from_(from), options_(options) {}

  PerspectiveGrid build() {
    std::copy(from_.at, from_.at + 3, g_.point);
    look(p_, ids_, large_, from_, options_.threads, sight_);
    g_.around = std::move(sight_.around);
    lay_tiles_for_few_references();
    each_seen([&](Seen& s, std::uint32_t) { s.to_tiles(g_.face[s.face]); });
    place_all();
    part_crowds();
    write();
    return std::move(g_);
  }

 private:
  bool is_sphere(std::uint32_t id) const { return p_.ids.has(PrimitiveKind::kSphere, id); }

  /// Lays fewer tiles where needles, or primitives that cover each other, would fill lists without
  /// bound; and no more than look-ups can number.
  void lay_tiles_for_few_references() {
    const double primitives = static_cast<double>(ids_.size());
    double density = std::min(options_.density, kMostTilesAtAll / std::max(primitives, 1.));
    for (lay_tiles(density); tiles_.size() > 2 * kFaces; lay_tiles(density)) {
      if (most_references() <= kMostExpectedEach * primitives)
        return;
      density /= 4;
    }
  }

  /// What lists hold at most, by the boxes around what is seen.
  double most_references() const {
    double sum = 0;
    for (std::uint32_t i = 0; i < seen_.pages() * SeenPages::kPage; ++i) {
      const Seen& s = seen_[i];
      if (s.id == kNoPrimitive)
        continue;
      const PointFace& f = g_.face[s.face];
      const Outline& o = s.outline;
      const double across = std::min((o.hi[0] - o.lo[0]) * f.per_u + 1, f.nx);
      const double up = std::min((o.hi[1] - o.lo[1]) * f.per_v + 1, f.ny);
      sum += across * up;
    }
    return sum;
  }

  void lay_tiles(double density) {
    tiles_.clear();
    std::uint64_t seen = 0;
    for (const Window& w : sight_.window)
      seen += w.seen;
    for (int f = 0; f < kFaces; ++f) {
      PointFace& face = g_.face[f];
      const Window& w = sight_.window[f];
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

  template <class Visit>
  void each_page(const Visit& visit) {
    Thrown thrown;
    const auto pages = static_cast<std::ptrdiff_t>(seen_.pages());
#pragma omp parallel for schedule(dynamic, 1) num_threads(options_.threads)
    for (std::ptrdiff_t page = 0; page < pages; ++page)
      thrown.in([&] { visit(static_cast<std::uint32_t>(page)); });
    thrown.on();
  }
  template <class Visit>
  void each_of_page(std::uint32_t page, const Visit& visit) {
    const std::uint32_t first = page * SeenPages::kPage;
    for (std::uint32_t i = first; i < first + SeenPages::kPage; ++i) {
      if (seen_[i].id == kNoPrimitive)
        return;
      visit(seen_[i], i);
    }
  }
  template <class Visit>
  void each_seen(const Visit& visit) {
    each_page([&](std::uint32_t page) { each_of_page(page, visit); });
  }

  /// Adds one, and returns what was there.
  std::uint32_t next(std::uint32_t& n) const {
    if (options_.threads == 1)
      return n++;
    return std::atomic_ref(n).fetch_add(1, std::memory_order_relaxed);
  }
  /// What stands in the list of a tile that a primitive belongs to.
  std::uint32_t& counted(const Place& at) {
    return counts_[2 * at.tile + in_boxes(at.seen)];
  }
  std::uint32_t in_boxes(std::uint32_t seen) const {
    return is_sphere(seen_[seen].id) ? 1 : 0;
  }
  std::uint32_t primitives_of(std::size_t tile) const {
    return counts_[2 * tile] + counts_[2 * tile + 1];
  }

  void place_all() {
    counts_.assign(2 * tiles_.size(), 0);
    places_.resize(seen_.pages());
    each_page([&](std::uint32_t page) {
      places_[page].reserve(4 * SeenPages::kPage);
      each_of_page(page,
                   [&](const Seen& s, std::uint32_t number) { place(s, number, places_[page]); });
      for (const Place& at : places_[page])
        next(counted(at));
    });
  }

  /// The tiles of its face that a primitive may be met in.
  void place(const Seen& s, std::uint32_t number, std::vector<Place>& to) const {
    const PointFace& face = g_.face[s.face];
    const auto first = static_cast<std::uint32_t>(face.first);
    const int columns = static_cast<int>(face.nx);
    const int rows = static_cast<int>(face.ny);
    const auto beyond = static_cast<std::uint32_t>(columns * rows);
    if (s.large)
      to.push_back({first + beyond, number});
    if (beyond == 0)
      return;
    TileWalk({0, 0, 1, columns, rows}, face).each(s, [&](std::uint32_t tile) {
      to.push_back({first + tile, number});
    });
  }

  /// Tiles with too many primitives get parts, and these again.
  void part_crowds() {
    g_.tiles.resize(tiles_.size());
    double references = 0;
    for (const std::uint32_t n : counts_)
      references += n;
    const double most = kMostReferencesEach * static_cast<double>(ids_.size());
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
      counts_.resize(2 * tiles_.size());
      place_parts();
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
    counts_[2 * t] = 0;
    counts_[2 * t + 1] = 0;
  }

  /// Takes what is placed in tiles with parts to these.
  void place_parts() {
    each_page([&](std::uint32_t page) {
      std::vector<Place> places;
      places.reserve(places_[page].size());
      for (const Place& p : places_[page]) {
        const TileLists& whole = g_.tiles[p.tile];
        if (whole.columns == 0) {
          places.push_back(p);
          continue;
        }
        const Tile& t = tiles_[p.tile];
        const int n = static_cast<int>(whole.columns);
        TileWalk({t.x, t.y, t.width / n, n, n}, g_.face[t.face])
            .each(seen_[p.seen], [&](std::uint32_t part) {
              places.push_back({whole.part + part, p.seen});
              next(counted(places.back()));
            });
      }
      places_[page] = std::move(places);
    });
  }

  /// Sets where the lists of a kind begin, from counts; which become the next free place of each
  /// list in all references, of which `before` come first. Returns how many there are.
  std::uint32_t begin_lists(int kind, std::uint32_t before) {
    std::uint32_t first = 0;
    for (std::size_t t = 0; t < tiles_.size(); ++t) {
      std::uint32_t& n = counts_[2 * t + static_cast<std::size_t>(kind)];
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
    each_page([&](std::uint32_t page) {
      for (const Place& p : places_[page])
        references_[next(counted(p))] = reference(seen_[p.seen], p.seen);
    });
    g_.outlines.resize(outlines / kOutlines + 1);
    g_.boxes.resize(boxes / kOutlines + 1);
    write_lists(kOutlineList, 0, [&](std::uint32_t at, const Seen& s, const Tile& t) {
      set_outline(g_.outlines[at / kOutlines], at % kOutlines, s, t);
    });
    write_lists(kBoxList, outlines, [&](std::uint32_t at, const Seen& s, const Tile& t) {
      set_box(g_.boxes[at / kOutlines], at % kOutlines, s, t);
    });
  }

  /// Asks for what is seen of a primitive, which comes from afar.
  static void fetch(const Seen& s) {
    const char* const bytes = reinterpret_cast<const char*>(&s);
    for (std::size_t line = 0; line < sizeof s; line += 64)
      __builtin_prefetch(bytes + line);
  }

  /// Writes the lists of a kind, of whose references `before` others come first.
  template <class Write>
  void write_lists(int kind, std::uint32_t before, const Write& write) {
    const auto n = static_cast<std::ptrdiff_t>(tiles_.size());
    Reference* const all = references_.data() + before;
#pragma omp parallel for schedule(dynamic, 256) num_threads(options_.threads)
    for (std::ptrdiff_t i = 0; i < n; ++i) {
      const auto t = static_cast<std::size_t>(i);
      const std::uint32_t first = g_.tiles[t].first[kind];
      const std::uint32_t end = g_.tiles[t + 1].first[kind];
      for (std::uint32_t at = first; at < end; ++at)
        fetch(seen_[all[at].seen]);
      std::sort(all + first, all + end);
      for (std::uint32_t at = first; at < end; ++at)
        write(at, seen_[all[at].seen], tiles_[t]);
    }
  }

  const Primitives& p_;
  std::span<const std::uint32_t> ids_, large_;
  const Viewpoint& from_;
  const PerspectiveOptions& options_;
  PerspectiveGrid g_;
  Sight sight_;
  SeenPages& seen_ = sight_.seen;
  std::vector<Tile> tiles_;
  /// [2 tiles] of each what is listed as outlines, then as boxes
  std::vector<std::uint32_t> counts_;
  std::vector<std::vector<Place>> places_;  ///< [pages of what is seen]
  RawVector<Reference> references_;
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
