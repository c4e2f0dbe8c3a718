#pragma once
// Who looks from a point at which primitives, and where they stand: the first step towards a grid.

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "kernel/perspective/look_loops.hpp"

namespace grelha {

/// Primitives `ids`, sorted, as seen from a point, looked at a thousand at a turn.
class Onlooker {
 public:
  static constexpr std::size_t kTurn = 1024;

  /// Primitives of `large`, which is sorted, are told apart from the others.
  Onlooker(const Primitives& primitives,
           std::span<const std::uint32_t> ids,
           std::span<const std::uint32_t> large,
           const Viewpoint& from,
           const LookLoops& loops)
      : primitives_(primitives), ids_(ids), large_(large), from_(from), loops_(loops) {}

  const Primitives& primitives() const { return primitives_; }
  std::size_t count() const { return ids_.size(); }
  std::size_t turns() const { return (ids_.size() + kTurn - 1) / kTurn; }
  /// Places among ids of those of a turn.
  std::size_t begin(std::size_t turn) const { return turn * kTurn; }
  std::size_t end(std::size_t turn) const { return std::min((turn + 1) * kTurn, ids_.size()); }

  std::uint32_t id(std::size_t i) const { return ids_[i]; }
  /// The other way round.
  std::size_t place_of(std::uint32_t id) const {
    return static_cast<std::size_t>(std::lower_bound(ids_.begin(), ids_.end(), id) - ids_.begin());
  }
  PrimitiveKind kind_of(std::uint32_t id) const { return primitives_.kind_of(id); }
  bool is_large(std::uint32_t id) const {
    return !large_.empty() && std::binary_search(large_.begin(), large_.end(), id);
  }
  /// What is nearer than kNearest pads has no outline.
  bool has_outline(const Glance& glance) const;
  /// Up to eight of one kind from place i on, before `end`.
  Few few(std::size_t i, std::size_t end) const;

  void survey(const Few& few, WindowRows (&window)[kFaces], Glance* glances) const {
    unsigned large = 0;
    for (int k = 0; k < few.count; ++k)
      large |= (is_large(few.id[k]) ? 1u : 0u) << k;
    loops_.survey(primitives_, from_, few, large, window, glances);
  }
  void see(const Few& few,
           const float (&distance)[kOutlines],
           int face,
           const PointFace& tiles,
           SeenFew& to) const {
    loops_.see(primitives_, from_, few, distance, face, tiles, to);
  }

 private:
  const Primitives& primitives_;
  std::span<const std::uint32_t> ids_, large_;
  const Viewpoint& from_;
  const LookLoops& loops_;
};

/// Where primitives stand around a point, before anything is known of tiles.
struct Sight {
  RawVector<Glance> glances;          ///< [ids]
  Window window[kFaces];              ///< the part of each face that anything is seen in
  std::vector<std::uint32_t> around;  ///< ids of what is too near to have an outline, sorted
};

/// The same for any number of threads.
Sight survey(const Onlooker& onlooker, int threads);

}  // namespace grelha
