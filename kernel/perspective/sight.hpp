#pragma once
// Who looks from a point at which primitives, and where they stand: the first step towards a grid.

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "kernel/perspective/distance.hpp"
#include "kernel/perspective/tiles.hpp"

namespace grelha {

/// Primitives `ids` as seen from a point, looked at a thousand at a turn.
class Onlooker {
 public:
  static constexpr std::size_t kTurn = 1024;

  /// Primitives of `large`, which is sorted, are told apart from the others.
  Onlooker(const Primitives& primitives,
           std::span<const std::uint32_t> ids,
           std::span<const std::uint32_t> large,
           const Viewpoint& from)
      : primitives_(primitives), ids_(ids), large_(large), from_(from) {}

  std::size_t count() const { return ids_.size(); }
  std::size_t turns() const { return (ids_.size() + kTurn - 1) / kTurn; }

  /// Calls visit(place among ids, id) for those of a turn.
  template <class Visit>
  void each(std::size_t turn, const Visit& visit) const {
    const std::size_t end = std::min((turn + 1) * kTurn, ids_.size());
    for (std::size_t i = turn * kTurn; i < end; ++i)
      visit(i, ids_[i]);
  }
  bool is_large(std::uint32_t id) const {
    return !large_.empty() && std::binary_search(large_.begin(), large_.end(), id);
  }
  Box box(std::uint32_t id) const { return primitives_.box(id); }
  double distance(std::uint32_t id, const Box& box) const {
    return distance_of(primitives_, from_, id, box);
  }
  /// What is nearer than kNearest pads has no outline.
  bool has_outline(double distance) const { return distance > kNearest * from_.pad; }
  unsigned faces(const Box& box) const { return faces_of(box, from_); }
  /// Outlines through a face, in directions; false: nothing is seen there.
  bool see(std::uint32_t id, int face, double distance, Outline& to) const {
    return grelha::see(primitives_, from_, id, face, distance, to);
  }
  bool see_about(std::uint32_t id, const Box& box, int face, double distance, Bounds& to) const {
    return grelha::see_about(primitives_, from_, id, box, face, distance, to);
  }

 private:
  const Primitives& primitives_;
  std::span<const std::uint32_t> ids_, large_;
  const Viewpoint& from_;
};

/// What a first look tells of a primitive: how far it is at least, and faces that it is seen
/// through, a bit each; none where it has no outline.
struct Glance {
  float distance;
  std::uint32_t faces;
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
