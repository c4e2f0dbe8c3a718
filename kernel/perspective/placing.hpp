#pragma once
// The tiles that primitives are placed in: those of the faces, and parts of crowded ones.

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <vector>

#include "kernel/perspective/sight.hpp"
#include "kernel/scene/pages.hpp"
#include "kernel/scene/turns.hpp"

namespace grelha {

/// Places primitives in the lists of tiles. Tiles that are too crowded get parts, which join the
/// others.
class Placing {
 public:
  static constexpr int kLists = 2;  ///< of a tile
  /// A primitive in a list: which of all tiles' lists, and number of what is seen of the primitive.
  struct Place {
    std::uint32_t list, seen;
  };
  /// Turns that one thread took, with what it has to itself: nobody waits for another's counts.
  struct Share {
    std::vector<std::size_t> turns;
    std::vector<std::uint32_t> counts;  ///< [lists of all tiles] what stands in each
  };

  /// `lists` has one for each tile, which parts are noted in.
  Placing(const Onlooker& onlooker,
          const Sight& sight,
          int threads,
          const PointFace (&faces)[kFaces],
          std::vector<Tile>& tiles,
          std::vector<TileLists>& lists)
      : p_(onlooker.primitives()),
        onlooker_(onlooker),
        sight_(sight),
        threads_(threads),
        faces_(faces),
        tiles_(tiles),
        lists_(lists) {}

  void place_all() {
    places_.resize(onlooker_.turns());
    shares_.resize(static_cast<std::size_t>(std::min(threads_, kMostShares)));
    for (Share& share : shares_)
      resize_to_fill(share.counts, kLists * tiles_.size());
    std::atomic<std::size_t> next = 0;
    each_turn(
        places_.size(),
        static_cast<int>(shares_.size()),
        [&] { return Writers(outlines_, boxes_, shares_[next++]); },
        [&](std::size_t turn, Writers& writers) {
          places_[turn].reserve(4 * Onlooker::kTurn);
          place_turn(turn, writers);
          writers.share.turns.push_back(turn);
          for (const Place& at : places_[turn])
            ++writers.share.counts[at.list];
        });
  }

  /// Tiles with too many primitives get parts, and these again.
  /// False: in parts, too, primitives cover each other so much that it is given up.
  bool part_crowds() {
    resize_to_fill(lists_, tiles_.size());
    const auto primitives = static_cast<double>(onlooker_.count());
    double references = references_from(0);
    std::size_t begin = 0;
    for (int level = 0; level < kMostLevels; ++level) {
      if (references >= kMostReferencesEach * primitives)
        return true;
      const std::size_t end = tiles_.size();
      for (std::size_t t = begin; t < end; ++t)
        if (primitives_of(t) > kTileCrowd && tiles_[t].width > 0)
          part(t);
      begin = end;
      if (tiles_.size() == end)
        return true;
      resize_to_fill(lists_, tiles_.size());
      place_all_parts(kMostReferencesInParts * primitives);
      references = references_from(end);
      if (references > kMostReferencesInParts * primitives)
        return false;
    }
    return true;
  }

  /// Calls work(share) for each, side by side.
  template <class Work>
  void each_share(const Work& work) {
    each_turn(
        shares_.size(), static_cast<int>(shares_.size()), [&](std::size_t i) { work(shares_[i]); });
  }

  std::vector<Share>& shares() { return shares_; }
  const std::vector<Place>& places(std::size_t turn) const { return places_[turn]; }
  const SeenPages<SeenOutline>& outlines() const { return outlines_; }
  const SeenPages<SeenBox>& boxes() const { return boxes_; }

 private:
  static constexpr double kMostReferencesEach = 16;  ///< a primitive, on average
  /// The same where tiles have parts: lists of more are longer than what a ray saves by them.
  static constexpr double kMostReferencesInParts = 128;
  static constexpr std::uint32_t kTileCrowd = 128;  ///< primitives of a tile that is parted
  static constexpr double kPartCrowd = 16;          ///< primitives that each part is meant for
  static constexpr int kMostColumns = 16;
  static constexpr int kMostLevels = 4;
  static constexpr int kMostShares = 16;  ///< each counts what stands in all tiles

  /// What a thread adds to.
  struct Writers {
    Writers(SeenPages<SeenOutline>& o, SeenPages<SeenBox>& b, Share& s)
        : outlines(o), boxes(b), share(s) {}
    SeenPages<SeenOutline>::Writer outlines;
    SeenPages<SeenBox>::Writer boxes;
    Share& share;
  };

  std::uint32_t primitives_of(std::size_t tile) const {
    std::uint32_t n = 0;
    for (const Share& share : shares_)
      n += share.counts[kLists * tile] + share.counts[kLists * tile + 1];
    return n;
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
    onlooker_.see(of.few, of.distance, f, faces_[f], seen);
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
    const PointFace& face = faces_[f];
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

  void part(std::size_t t) {
    const int columns = static_cast<int>(
        std::clamp(std::ceil(std::sqrt(primitives_of(t) / kPartCrowd)), 2., double{kMostColumns}));
    lists_[t].part = static_cast<std::uint32_t>(tiles_.size());
    lists_[t].columns = static_cast<std::uint32_t>(columns);
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
    for (Share& share : shares_)
      share.counts[kLists * t] = share.counts[kLists * t + 1] = 0;
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

  /// Of tiles from number `first` on.
  double references_from(std::size_t first) const {
    double sum = 0;
    for (std::size_t t = first; t < tiles_.size(); ++t)
      sum += primitives_of(t);
    return sum;
  }

  /// Stops where any share has placed more than `most`.
  void place_all_parts(double most) {
    each_share([&](Share& share) {
      resize_to_fill(share.counts, kLists * tiles_.size());
      double placed = 0;
      for (std::size_t i = 0; i < share.turns.size() && placed <= most; ++i)
        placed += static_cast<double>(place_parts(places_[share.turns[i]], share));
    });
  }

  /// Takes what is placed in tiles with parts to these; returns how many places it has there.
  std::size_t place_parts(std::vector<Place>& places, Share& share) const {
    const auto in_parts = [&](const Place& p) { return lists_[p.list / kLists].columns > 0; };
    auto kept = std::find_if(places.begin(), places.end(), in_parts);
    Crowd crowd;
    std::vector<Place> placed;
    for (auto at = kept; at != places.end(); ++at)
      if (in_parts(*at))
        add(*at, crowd, placed);
      else
        *kept++ = *at;
    place_crowd(crowd, placed);
    for (const Place& p : placed)
      ++share.counts[p.list];
    places.erase(kept, places.end());
    places.insert(places.end(), placed.begin(), placed.end());
    return placed.size();
  }

  /// Adds a place, and before it ends what cannot take its primitive.
  void add(const Place& p, Crowd& crowd, std::vector<Place>& to) const {
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
  void place_crowd(const Crowd& crowd, std::vector<Place>& to) const {
    if (crowd.places.empty())
      return;
    SeenFew seen;
    onlooker_.see(crowd.of.few, crowd.of.distance, crowd.face, faces_[crowd.face], seen);
    for (std::size_t i = 0; i < crowd.places.size(); ++i) {
      const Place& p = crowd.places[i];
      const std::uint32_t tile = p.list / kLists;
      const Tile& t = tiles_[tile];
      const int n = static_cast<int>(lists_[tile].columns);
      TileWalk({t.x, t.y, t.width / n, n, n}).each(seen, crowd.which[i], [&](std::uint32_t part) {
        to.push_back({kLists * (lists_[tile].part + part) + p.list % kLists, p.seen});
      });
    }
  }

  const Primitives& p_;
  const Onlooker& onlooker_;
  const Sight& sight_;
  int threads_;
  const PointFace (&faces_)[kFaces];
  std::vector<Tile>& tiles_;
  std::vector<TileLists>& lists_;
  SeenPages<SeenOutline> outlines_;
  SeenPages<SeenBox> boxes_;
  std::vector<std::vector<Place>> places_;  ///< [turns]
  std::vector<Share> shares_;               ///< one a thread
};

}  // namespace grelha
