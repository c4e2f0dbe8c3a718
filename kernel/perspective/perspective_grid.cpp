#include "kernel/perspective/perspective_grid.hpp"

#include <algorithm>

#include "kernel/perspective/lists.hpp"
#include "kernel/perspective/placing.hpp"
#include "kernel/scene/pages.hpp"

namespace grelha {
namespace {

constexpr double kMostExpectedEach = 64;  ///< references a primitive, by bounds of what is seen
/// Primitives that stand one behind another, on average, by bounds of what is seen: of more, lists
/// are longer than what a ray saves by them, however small tiles are.
constexpr double kMostBehind = 128;
constexpr double kMostTilesAtAll = 0x1p22;  ///< before crowds get parts

class Builder {
 public:
  Builder(const Primitives& p,
          std::span<const std::uint32_t> ids,
          std::span<const std::uint32_t> large,
          const Viewpoint& from,
          const PerspectiveOptions& options)
      : onlooker_(p, ids, large, from, options.loops), options_(options), primitives_(ids.size()) {
    std::copy(from.at, from.at + 3, g_.point);
  }

  std::optional<PerspectiveGrid> build() {
    Sight sight = survey(onlooker_, options_.threads);
    if (is_heap(sight.window))
      return std::nullopt;
    g_.around = std::move(sight.around);
    lay_tiles_for_few_references(sight.window);
    Placing placing(onlooker_, sight, options_.threads, g_.face, tiles_, g_.tiles);
    placing.place_all();
    if (!placing.part_crowds())
      return std::nullopt;
    write(placing);
    return std::move(g_);
  }

 private:
  static bool is_heap(const Window (&window)[kFaces]) {
    double seen = 0;
    double behind = 0;
    for (const Window& w : window) {
      const double whole = (w.hi[0] - w.lo[0]) * (w.hi[1] - w.lo[1]);
      if (w.seen == 0 || !(whole > 0))
        continue;
      seen += static_cast<double>(w.seen);
      behind += static_cast<double>(w.seen) * (w.area / whole);
    }
    return behind > kMostBehind * seen;
  }

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
      const auto columns = static_cast<std::size_t>(face.nx),
                 rows = static_cast<std::size_t>(face.ny);
      reserve_to_fill(tiles_, tiles_.size() + columns * rows + 1);
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

  /// Sets where the lists of a kind begin, from counts; which become each share's next free place
  /// of each list in all references, of which `before` come first. Returns how many there are.
  std::uint32_t begin_lists(Placing& placing, int kind, std::uint32_t before) {
    std::uint32_t first = 0;
    for (std::size_t t = 0; t < tiles_.size(); ++t) {
      g_.tiles[t].first[kind] = first;
      for (Placing::Share& share : placing.shares()) {
        std::uint32_t& n = share.counts[Placing::kLists * t + static_cast<std::size_t>(kind)];
        first += n;
        n = before + first - n;
      }
    }
    g_.tiles.back().first[kind] = first;
    return first;
  }

  void write(Placing& placing) {
    resize_to_fill(g_.tiles, tiles_.size() + 1);
    const std::uint32_t outlines = begin_lists(placing, kOutlineList, 0);
    const std::uint32_t boxes = begin_lists(placing, kBoxList, outlines);
    references_.resize(outlines + boxes);
    placing.each_share([&](Placing::Share& share) {
      for (const std::size_t turn : share.turns)
        for (const Placing::Place& p : placing.places(turn))
          references_[share.counts[p.list]++] = p.seen;
    });
    g_.outlines.resize(outlines / kOutlines + 1);
    g_.boxes.resize(boxes / kOutlines + 1);
    const std::span<const std::uint32_t> all(references_.data(), references_.size());
    write_lists<SeenOutline>(
        {kOutlineList, tiles_, g_.tiles, all.first(outlines), placing.outlines()},
        options_.loops,
        options_.threads,
        g_.outlines.data());
    write_lists<SeenBox>({kBoxList, tiles_, g_.tiles, all.subspan(outlines), placing.boxes()},
                         options_.loops,
                         options_.threads,
                         g_.boxes.data());
  }

  const Onlooker onlooker_;
  const PerspectiveOptions& options_;
  const std::size_t primitives_;
  PerspectiveGrid g_;
  std::vector<Tile> tiles_;
  RawVector<std::uint32_t> references_;  ///< what is seen, list after list
};

}  // namespace

std::optional<PerspectiveGrid> build_perspective_grid(const Primitives& primitives,
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
  v.outlines = tiles.back().first[kOutlineList] > 0 ? outlines.data() : nullptr;
  v.boxes = tiles.back().first[kBoxList] > 0 ? boxes.data() : nullptr;
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
