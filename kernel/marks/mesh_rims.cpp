#include "kernel/marks/mesh_rims.hpp"

#include <algorithm>
#include <bit>
#include <mutex>

#include "kernel/scene/hash.hpp"
#include "kernel/scene/turns.hpp"

namespace grelha {
namespace {

constexpr std::size_t kMostTriangles = std::size_t{1} << 22;  ///< of more, nothing is kept
constexpr std::size_t kItemsOfTurn = 4096;

using Words = std::vector<std::atomic<std::uint32_t>>;

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

/// The vertex that came first to the place of another, by open addressing.
std::uint32_t first_at_place(const TriangleSpans& t,
                             std::uint32_t vertex,
                             std::uint32_t name,
                             Words& held) {
  for (std::size_t at = name;; ++at) {
    std::atomic<std::uint32_t>& slot = held[at & (held.size() - 1)];
    std::uint32_t there = slot.load(std::memory_order_relaxed);
    if (there == 0 && slot.compare_exchange_strong(there, vertex + 1, std::memory_order_relaxed))
      return vertex;
    if (same_place(t, there - 1, vertex))
      return there - 1;
  }
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

MeshRims::MeshRims(const TriangleSpans& triangles, int threads)
    : triangles_(triangles), threads_(threads) {
  if (triangles.size() > kMostTriangles)
    return;
  const std::size_t vertices = triangles.vertex_count();
  first_.resize(vertices);
  told_ = std::vector<std::atomic<std::uint8_t>>(vertices);
  Words held(std::bit_ceil(2 * vertices));  // a vertex + 1
  Words open(vertices);
  std::vector<std::uint32_t> name(vertices);
  each_of(vertices, threads, [&](std::size_t v) {
    const auto vertex = static_cast<std::uint32_t>(v);
    name[v] = hash_of_place(triangles, vertex);
    first_[v] = first_at_place(triangles, vertex, name[v], held);
  });
  each_of(triangles.size(), threads, [&](std::size_t i) { add_neighbours(i, name, open); });
  each_of(vertices, threads, [&](std::size_t v) { told_[v] = open[v] != 0 ? kOpen : 0; });
  find_borders();
}

int MeshRims::open_corners(std::size_t i) const {
  return is_open(triangles_.a[i]) + is_open(triangles_.b[i]) + is_open(triangles_.c[i]);
}

MeshRims::Edge MeshRims::edge(std::size_t i, int k) const {
  const std::uint32_t vertex[3] = {triangles_.a[i], triangles_.b[i], triangles_.c[i]};
  const auto [lower, upper] = std::minmax(first_[vertex[k]], first_[vertex[(k + 1) % 3]]);
  return {lower, upper, triangles_.material[i]};
}

/// With one corner inside, the edge of the other two is all that loners may have in common with it.
void MeshRims::find_borders() {
  std::mutex adding;
  each_of(triangles_.size(), threads_, [&](std::size_t i) {
    if (open_corners(i) != 2)
      return;
    const int k = !is_open(triangles_.a[i]) ? 1 : !is_open(triangles_.b[i]) ? 2 : 0;
    const std::lock_guard lock(adding);
    borders_.push_back(edge(i, k));
  });
  std::sort(borders_.begin(), borders_.end());
}

/// Adds to each corner of a triangle its neighbours there, by `name`. Those that come twice are
/// gone: of a corner inside of a mesh 0 is left.
void MeshRims::add_neighbours(std::size_t i,
                              const std::vector<std::uint32_t>& name,
                              std::vector<std::atomic<std::uint32_t>>& open) const {
  const std::uint32_t vertex[3] = {triangles_.a[i], triangles_.b[i], triangles_.c[i]};
  std::uint32_t of[3];
  for (int k = 0; k < 3; ++k)
    of[k] = scattered_bits(name[vertex[k]] + triangles_.material[i]);
  for (int k = 0; k < 3; ++k)
    open[first_[vertex[k]]].fetch_xor(of[(k + 1) % 3] ^ of[(k + 2) % 3], std::memory_order_relaxed);
}

void MeshRims::look_from(const double (&point)[3]) {
  if (told_.empty())
    return;
  std::copy(point, point + 3, from_);
  for (std::atomic<std::uint8_t>& told : told_)
    told.store(told.load(std::memory_order_relaxed) & kOpen, std::memory_order_relaxed);
  each_of(triangles_.size(), threads_, [&](std::size_t i) { add_side(i); });
}

/// Which side of a triangle is seen. Those of a mesh need not be turned alike.
std::uint8_t MeshRims::side_of(std::size_t i) const {
  const std::uint32_t vertex[3] = {triangles_.a[i], triangles_.b[i], triangles_.c[i]};
  double p[3][3];
  for (int k = 0; k < 3; ++k) {
    p[k][0] = triangles_.x[vertex[k]] - from_[0];
    p[k][1] = triangles_.y[vertex[k]] - from_[1];
    p[k][2] = triangles_.z[vertex[k]] - from_[2];
  }
  const double volume = p[0][0] * (p[1][1] * p[2][2] - p[1][2] * p[2][1]) +
                        p[0][1] * (p[1][2] * p[2][0] - p[1][0] * p[2][2]) +
                        p[0][2] * (p[1][0] * p[2][1] - p[1][1] * p[2][0]);
  return volume < 0 ? kFront : kBack;
}

void MeshRims::add_side(std::size_t i) {
  const std::uint8_t side = side_of(i);
  for (const std::uint32_t v : {triangles_.a[i], triangles_.b[i], triangles_.c[i]}) {
    std::atomic<std::uint8_t>& seen = told_[first_[v]];
    if ((seen.load(std::memory_order_relaxed) & side) == 0)
      seen.fetch_or(side, std::memory_order_relaxed);
  }
}

bool MeshRims::stands_alone(std::size_t i) const {
  if (told_.empty())
    return true;
  if (open_corners(i) < 3)
    return false;
  for (int k = 0; k < 3; ++k)
    if (std::binary_search(borders_.begin(), borders_.end(), edge(i, k)))
      return false;
  return true;
}

bool MeshRims::ends_at(std::size_t i) const {
  return told_.empty() || open_corners(i) > 0;
}

bool MeshRims::has(std::size_t i) const {
  if (told_.empty())
    return true;
  bool any = false;
  for (const std::uint32_t v : {triangles_.a[i], triangles_.b[i], triangles_.c[i]}) {
    const std::uint8_t told = told_[first_[v]];
    any |= (told & kOpen) != 0 || told == (kFront | kBack);
  }
  return any;
}

}  // namespace grelha
