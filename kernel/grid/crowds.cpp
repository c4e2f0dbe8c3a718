#include "kernel/grid/crowds.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/grid/grid_layout.hpp"

namespace grelha {
namespace {

constexpr std::size_t kLookedAt = 1024;  ///< primitives looked at
constexpr std::size_t kCrowd = 512;      ///< in one cell
/// in the cell of the mean primitive: with fewer, more grids may cost more than they gain (balls 6:
/// 79)
constexpr std::size_t kBad = 4096;
constexpr std::size_t kSeen = 8;  ///< of the probe, so that chance makes no crowd
constexpr double kSmaller = .5;   ///< a crowd's diagonal over its box's

struct Cell {
  std::int32_t at[3];
  auto operator<=>(const Cell&) const = default;
  bool is_within(int reach, const Cell& o) const {
    bool near = true;
    for (int a = 0; a < 3; ++a)
      near &= std::abs(at[a] - o.at[a]) <= reach;
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

std::vector<Cell> crowded(const Cells& cells, const std::vector<std::uint32_t>& ids) {
  const std::size_t stride = std::max<std::size_t>(1, ids.size() / kLookedAt),
                    least = std::max(kSeen, kCrowd / stride);
  std::vector<Cell> seen, out;
  for (std::size_t i = 0; i < ids.size(); i += stride)
    seen.push_back(cells.of(ids[i]));
  std::sort(seen.begin(), seen.end());
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

/// The crowd each crowded cell belongs to, numbered from 0; returns how many there are.
std::size_t join(const std::vector<Cell>& cells, std::vector<std::size_t>& crowd) {
  std::size_t count = 0;
  crowd.assign(cells.size(), cells.size());
  std::vector<std::size_t> next;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (crowd[i] != cells.size())
      continue;
    crowd[i] = count;
    next.push_back(i);
    while (!next.empty()) {
      const std::size_t from = next.back();
      next.pop_back();
      for (std::size_t k = 0; k < cells.size(); ++k)
        if (crowd[k] == cells.size() && cells[k].is_within(1, cells[from])) {
          crowd[k] = count;
          next.push_back(k);
        }
    }
    ++count;
  }
  return count;
}

}  // namespace

std::vector<std::vector<std::uint32_t>> take_crowds(const Primitives& p,
                                                    std::vector<std::uint32_t>& ids,
                                                    const Box& box,
                                                    double density,
                                                    std::size_t most) {
  std::vector<std::vector<std::uint32_t>> out;
  if (ids.size() <= kCrowd || most == 0)
    return out;
  const Cells cells(p, box, cell_edge(box, ids.size(), density));
  const std::vector<Cell> full = crowded(cells, ids);
  std::vector<std::size_t> crowd;
  const std::size_t crowds = join(full, crowd);
  // With the outskirts, which are crowded as well, or where these reach too far without.
  for (const int reach : {1, 0}) {
    if (full.empty() || !out.empty())
      break;
    std::vector<std::vector<std::uint32_t>> found(crowds);
    std::vector<std::uint32_t> rest;
    for (const std::uint32_t id : ids) {
      const Cell c = cells.of(id);
      const auto near = std::find_if(
          full.begin(), full.end(), [&](const Cell& f) { return f.is_within(reach, c); });
      (near == full.end() ? rest : found[crowd[static_cast<std::size_t>(near - full.begin())]])
          .push_back(id);
    }
    for (auto& one : found) {
      if (out.size() < most && extent_of(p, one, 1).box.diagonal() < kSmaller * box.diagonal())
        out.push_back(std::move(one));
      else
        rest.insert(rest.end(), one.begin(), one.end());
    }
    if (out.empty())
      continue;
    std::sort(rest.begin(), rest.end());
    ids = std::move(rest);
  }
  return out;
}

}  // namespace grelha
