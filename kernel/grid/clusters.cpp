#include "kernel/grid/plan.hpp"

#include <algorithm>
#include <cmath>

namespace grelha {
namespace {

constexpr std::size_t kLookedAt = 1024;  ///< primitives looked at
constexpr std::size_t kCluster = 512;    ///< in one cell
/// in the cell of the mean primitive: with fewer, more grids may cost more than they gain (balls 6:
/// 79)
constexpr std::size_t kBad = 4096;
constexpr std::size_t kMinProbed = 8;  ///< of the probe, so that chance makes no cluster
constexpr double kSmaller = .5;        ///< a cluster's diagonal over its box's

struct Cell {
  std::int32_t at[3];
  auto operator<=>(const Cell&) const = default;
  bool is_within(int radius, const Cell& o) const {
    bool near = true;
    for (int a = 0; a < 3; ++a)
      near &= std::abs(at[a] - o.at[a]) <= radius;
    return near;
  }
};

class Cells {
 public:
  Cells(const Primitives& p, const Box& box, double edge) : p_(p), box_(box), inverse_(1 / edge) {}
  Cell of(std::uint32_t id) const {
    const Box b = p_.box(id);
    Cell c;
    for (int a = 0; a < 3; ++a)
      c.at[a] = static_cast<std::int32_t>(((.5 * b.lo[a] + .5 * b.hi[a]) - box_.lo[a]) * inverse_);
    return c;
  }

 private:
  const Primitives& p_;
  const Box& box_;
  double inverse_;
};

/// The cells of every `stride`-th primitive, ascending.
std::vector<Cell> looked_at(const Cells& cells,
                            const std::vector<std::uint32_t>& ids,
                            std::size_t stride) {
  std::vector<Cell> seen;
  for (std::size_t i = 0; i < ids.size(); i += stride)
    seen.push_back(cells.of(ids[i]));
  std::sort(seen.begin(), seen.end());
  return seen;
}

/// Cells that many of the primitives looked at stand in, if the mean one stands among many.
std::vector<Cell> clustered(const Cells& cells, const std::vector<std::uint32_t>& ids) {
  const std::size_t stride = std::max<std::size_t>(1, ids.size() / kLookedAt);
  const std::size_t least = std::max(kMinProbed, kCluster / stride);
  const std::vector<Cell> seen = looked_at(cells, ids, stride);
  std::vector<Cell> out;
  std::size_t squares = 0;
  for (auto from = seen.begin(); from != seen.end();) {
    const auto to = std::upper_bound(from, seen.end(), *from);
    const auto count = static_cast<std::size_t>(to - from);
    squares += count * count;
    if (count > least)
      out.push_back(*from);
    from = to;
  }
  if (squares * stride < kBad * seen.size())
    out.clear();
  return out;
}

/// Clustered cells, and the cluster that each belongs to.
struct Clusters {
  std::vector<Cell> cells;
  std::vector<std::size_t> cluster;  ///< [cells] numbered from 0
  std::size_t count = 0;

  explicit Clusters(std::vector<Cell> of)
      : cells(std::move(of)), cluster(cells.size(), cells.size()) {
    for (std::size_t i = 0; i < cells.size(); ++i)
      if (!has_cluster(i))
        join(i, count++);
  }

  /// The cell that a primitive's is at most `radius` from, or cells.size().
  std::size_t near(const Cell& c, int radius) const {
    const auto is_near = [&](const Cell& f) { return f.is_within(radius, c); };
    const auto at = std::find_if(cells.begin(), cells.end(), is_near);
    return static_cast<std::size_t>(at - cells.begin());
  }

 private:
  bool has_cluster(std::size_t i) const { return cluster[i] != cells.size(); }

  /// Makes a cell, its neighbours and theirs one cluster.
  void join(std::size_t first, std::size_t number) {
    std::vector<std::size_t> next = {first};
    cluster[first] = number;
    while (!next.empty()) {
      const std::size_t from = next.back();
      next.pop_back();
      for (std::size_t k = 0; k < cells.size(); ++k)
        if (!has_cluster(k) && cells[k].is_within(1, cells[from])) {
          cluster[k] = number;
          next.push_back(k);
        }
    }
  }
};

using Ids = std::vector<std::uint32_t>;

/// Primitives by cluster, and those in none.
struct Sorted {
  std::vector<Ids> clusters;
  Ids rest;
};
Sorted sort_out(const Ids& ids, const Cells& cells, const Clusters& all, int radius) {
  Sorted found;
  found.clusters.resize(all.count);
  for (const std::uint32_t id : ids) {
    const std::size_t cell = all.near(cells.of(id), radius);
    Ids& to = cell == all.cells.size() ? found.rest : found.clusters[all.cluster[cell]];
    to.push_back(id);
  }
  return found;
}

/// Takes out up to `most` clusters that span less than a length. Others join the rest.
std::vector<Ids> take_small(const Primitives& p, Sorted& found, double length, std::size_t most) {
  std::vector<Ids> out;
  for (Ids& one : found.clusters) {
    if (out.size() < most && extent_of(p, one, 1).box.diagonal() < length)
      out.push_back(std::move(one));
    else
      found.rest.insert(found.rest.end(), one.begin(), one.end());
  }
  std::sort(found.rest.begin(), found.rest.end());
  return out;
}

}  // namespace

std::vector<Ids> take_clusters(
    const Primitives& p, Ids& ids, const Box& box, double density, std::size_t most) {
  std::vector<Ids> out;
  if (ids.size() <= kCluster || most == 0)
    return out;
  const Cells cells(p, box, cell_edge(box, ids.size(), density));
  const Clusters all(clustered(cells, ids));
  // With the outskirts, which are dense as well, or where these reach too far without.
  for (const int radius : {1, 0}) {
    if (all.count == 0 || !out.empty())
      break;
    Sorted found = sort_out(ids, cells, all, radius);
    out = take_small(p, found, kSmaller * box.diagonal(), most);
    if (!out.empty())
      ids = std::move(found.rest);
  }
  return out;
}

}  // namespace grelha
