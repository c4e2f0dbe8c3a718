#include "kernel/marks/mesh_rims.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <compare>

#include "kernel/scene/hash.hpp"
#include "kernel/scene/pages.hpp"
#include "kernel/scene/raw_vector.hpp"
#include "kernel/scene/turns.hpp"

namespace grelha {
namespace {

constexpr std::size_t kMostTriangles = std::size_t{1} << 22;  ///< of more, nothing is kept
constexpr std::size_t kItemsOfTurn = 4096;

using Words = std::vector<std::uint32_t>;
using SharedWord = std::atomic_ref<std::uint32_t>;

/// Bits that are the same for 0 and -0.
std::uint32_t bits_of_coordinate(float x) {
  return std::bit_cast<std::uint32_t>(x + 0.f);
}

std::uint32_t hash_of_place(const TriangleSpans& t, std::uint32_t vertex) {
  std::uint32_t h = scattered_bits(bits_of_coordinate(t.x[vertex]));
  h = scattered_bits(h ^ bits_of_coordinate(t.y[vertex]));
  return scattered_bits(h + bits_of_coordinate(t.z[vertex]));
}

bool same_place(const TriangleSpans& t, std::uint32_t a, std::uint32_t b) {
  return t.x[a] == t.x[b] && t.y[a] == t.y[b] && t.z[a] == t.z[b];
}

/// A vertex at the place of another, the same for all that are there, by open addressing.
std::uint32_t one_at_place(const TriangleSpans& t, std::uint32_t vertex, Words& held) {
  for (std::size_t at = hash_of_place(t, vertex);; ++at) {
    const SharedWord slot(held[at & (held.size() - 1)]);
    std::uint32_t there = slot.load(std::memory_order_relaxed);
    if (there == 0 && slot.compare_exchange_strong(there, vertex + 1, std::memory_order_relaxed))
      return vertex;
    if (same_place(t, there - 1, vertex))
      return there - 1;
  }
}

/// Adds 1 and returns what was there. A thread alone needs no lock, which takes longer than all
/// else.
std::uint32_t counted(std::uint32_t& count, int threads) {
  return threads > 1 ? SharedWord(count).fetch_add(1, std::memory_order_relaxed) : count++;
}

template <class Work>
void each_of(std::size_t count, int threads, const Work& work) {
  each_turn((count + kItemsOfTurn - 1) / kItemsOfTurn, threads, [&](std::size_t turn) {
    const std::size_t end = std::min((turn + 1) * kItemsOfTurn, count);
    for (std::size_t i = turn * kItemsOfTurn; i < end; ++i)
      work(i);
  });
}

}  // namespace

/// The edges of all triangles.
class MeshRims::Edges {
 public:
  Edges(const TriangleSpans& triangles, int threads)
      : triangles_(triangles),
        place_(array_to_fill<Words>(triangles.vertex_count())),
        begin_(array_to_fill<Words>(place_.size() + 1)),
        edges_(3 * triangles.size()) {
    auto held = array_to_fill<Words>(std::bit_ceil(2 * place_.size()));  // a vertex + 1
    each_of(place_.size(), threads, [&](std::size_t v) {
      place_[v] = one_at_place(triangles, static_cast<std::uint32_t>(v), held);
    });
    auto next = array_to_fill<Words>(place_.size());
    each_edge(threads, [&](std::uint32_t lower, const Edge&) { counted(next[lower], threads); });
    for (std::size_t v = 0; v < place_.size(); ++v) {
      begin_[v + 1] = begin_[v] + next[v];
      next[v] = begin_[v];
    }
    each_edge(threads, [&](std::uint32_t lower, const Edge& edge) {
      edges_[counted(next[lower], threads)] = edge;
    });
  }

  /// The places of a triangle's corners, each named by one of the vertices there.
  std::array<std::uint32_t, 3> corners(std::size_t i) const {
    return {place_[triangles_.a[i]], place_[triangles_.b[i]], place_[triangles_.c[i]]};
  }
  static bool is_flat(const std::array<std::uint32_t, 3>& corner) {
    return corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0];
  }

  /// Sets what lies across the edges from a place to greater ones.
  void link(std::size_t place, std::vector<std::uint32_t>& across) {
    const auto end = edges_.begin() + begin_[place + 1];
    auto first = edges_.begin() + begin_[place];
    std::sort(first, end);
    while (first != end) {
      const auto last = std::find_if(
          first + 1, end, [&](const Edge& edge) { return edge.upper != first->upper; });
      link({first, last}, across);
      first = last;
    }
  }

 private:
  /// Edge number % 3 of triangle number / 3, to the greater of the places at its ends.
  struct Edge {
    std::uint32_t upper, number;
    auto operator<=>(const Edge&) const = default;
    std::uint32_t triangle() const { return number / 3; }
  };

  std::uint32_t material(const Edge& edge) const { return triangles_.material[edge.triangle()]; }

  /// The same of edges between two places: across each lies the next of its material, across the
  /// last the first.
  void link(std::span<Edge> edges, std::vector<std::uint32_t>& across) const {
    if (edges.size() > 2)
      std::stable_sort(edges.begin(), edges.end(), [&](const Edge& a, const Edge& b) {
        return material(a) < material(b);
      });
    std::size_t first = 0;
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const bool last = i + 1 == edges.size() || material(edges[i]) != material(edges[i + 1]);
      if (i > first || !last)
        across[edges[i].number] = edges[last ? first : i + 1].triangle();
      if (last)
        first = i + 1;
    }
  }

  /// Calls visit(lower, edge) for the edges of triangles that have any.
  template <class Visit>
  void each_edge(int threads, const Visit& visit) const {
    each_of(triangles_.size(), threads, [&](std::size_t i) {
      const std::array<std::uint32_t, 3> corner = corners(i);
      for (std::size_t k = 0; k < 3 && !is_flat(corner); ++k) {
        const auto [lower, upper] = std::minmax(corner[k], corner[(k + 1) % 3]);
        visit(lower, {upper, static_cast<std::uint32_t>(3 * i + k)});
      }
    });
  }

  const TriangleSpans& triangles_;
  Words place_;            ///< [vertices] one at the same place
  Words begin_;            ///< [places + 1] of the edges of each
  RawVector<Edge> edges_;  ///< by the lesser of the places at their ends
};

MeshRims::MeshRims(const TriangleSpans& triangles, int threads)
    : triangles_(triangles), threads_(threads) {
  if (triangles.size() > kMostTriangles)
    return;
  resize_to_fill(across_, 3 * triangles.size(), kNone);
  resize_to_fill(told_, triangles.size());
  resize_to_fill(sides_, triangles.size());
  Edges edges(triangles, threads);
  each_of(triangles.vertex_count(), threads, [&](std::size_t v) { edges.link(v, across_); });
  tell_of_corners(edges);
}

void MeshRims::tell_of_corners(const Edges& edges) {
  std::vector<std::atomic<bool>> open(triangles_.vertex_count());
  each_of(triangles_.size(), threads_, [&](std::size_t i) {
    const std::array<std::uint32_t, 3> corner = edges.corners(i);
    told_[i] = Edges::is_flat(corner) ? kFlat : 0;
    for (std::size_t k = 0; k < 3 && told_[i] != kFlat; ++k)
      if (across_[3 * i + k] == kNone) {
        told_[i] |= static_cast<std::uint8_t>(1u << k);
        open[corner[k]].store(true, std::memory_order_relaxed);
        open[corner[(k + 1) % 3]].store(true, std::memory_order_relaxed);
      }
  });
  each_of(triangles_.size(), threads_, [&](std::size_t i) {
    const std::array<std::uint32_t, 3> corner = edges.corners(i);
    if (told_[i] != kFlat && open[corner[0]] && open[corner[1]] && open[corner[2]])
      told_[i] |= kOpenCorners;
  });
}

void MeshRims::look_from(std::span<const SeenFrom> from) {
  each_of(sides_.size(), threads_, [&](std::size_t i) { sides_[i] = sides_of(i, from); });
}

/// Which side of a triangle is seen. Those of a mesh need not be turned alike.
std::uint8_t MeshRims::sides_of(std::size_t i, std::span<const SeenFrom> from) const {
  const Triple a = vertex_of(triangles_, triangles_.a[i]);
  const Triple normal = cross(minus(vertex_of(triangles_, triangles_.b[i]), a),
                              minus(vertex_of(triangles_, triangles_.c[i]), a));
  unsigned backs = 0;
  for (std::size_t v = 0; v < from.size(); ++v) {
    const double(&at)[3] = from[v].at;
    backs |= unsigned{dot(minus(a, {at[0], at[1], at[2]}), normal) >= 0} << v;
  }
  return static_cast<std::uint8_t>(backs);
}

unsigned MeshRims::rims(std::size_t i, std::size_t v) const {
  unsigned bits = ends(i);
  for (std::size_t k = 0; k < 3; ++k)
    if (const std::uint32_t other = across_[3 * i + k]; other != kNone)
      bits |= ((unsigned{sides_[i]} ^ sides_[other]) >> v & 1) << k;
  return bits;
}

unsigned MeshRims::ends(std::size_t i) const {
  return told_[i] & kEnds;
}

bool MeshRims::stands_alone(std::size_t i) const {
  if ((told_[i] & kOpenCorners) == 0)
    return false;
  for (std::size_t k = 0; k < 3; ++k)
    if (const std::uint32_t other = across_[3 * i + k];
        other != kNone && (told_[other] & kOpenCorners) == 0)
      return false;
  return true;
}

}  // namespace grelha
