#include "kernel/grid/distance_field.hpp"

#include <algorithm>

#include "kernel/base/parallel_for.hpp"

namespace grelha {
namespace {

constexpr std::uint8_t kFarthest = 255;

/// The distances of one octant, row by row against its way.
class OctantSweep {
 public:
  OctantSweep(const std::uint8_t* empty,
              std::uint8_t* to,
              const std::array<std::uint32_t, 3>& cells,
              std::size_t octant)
      : empty_(empty),
        to_(to),
        n_{cells[0], cells[1], cells[2]},
        octant_(octant),
        nothing_(cells[0], kFarthest),
        least_(cells[0] + 1) {}

  void run() {
    for (std::ptrdiff_t k = 0; k < n_[2]; ++k)
      for (std::ptrdiff_t j = 0; j < n_[1]; ++j)
        row(index_of(1, j), index_of(2, k));
  }

 private:
  bool is_down(int axis) const { return octant_ >> axis & 1; }
  /// The i-th position along an axis, the last on the way of the octant first.
  std::ptrdiff_t index_of(int axis, std::ptrdiff_t i) const {
    return is_down(axis) ? i : n_[axis] - 1 - i;
  }
  std::ptrdiff_t next(int axis, std::ptrdiff_t i) const { return is_down(axis) ? i - 1 : i + 1; }

  std::ptrdiff_t start_of(std::ptrdiff_t y, std::ptrdiff_t z) const {
    return (z * n_[1] + y) * n_[0];
  }
  const std::uint8_t* found(std::ptrdiff_t y, std::ptrdiff_t z) const {
    const bool is_inside = y >= 0 && y < n_[1] && z >= 0 && z < n_[2];
    return is_inside ? to_ + start_of(y, z) : nothing_.data();
  }

  void row(std::ptrdiff_t y, std::ptrdiff_t z) {
    const std::uint8_t* const a = found(next(1, y), z);
    const std::uint8_t* const b = found(y, next(2, z));
    const std::uint8_t* const c = found(next(1, y), next(2, z));
    // where x goes down, a row stands one index further on, behind the border of the grid
    std::uint8_t* const least = least_.data() + is_down(0);
    for (std::ptrdiff_t x = 0; x < n_[0]; ++x)
      least[x] = std::min(std::min(a[x], b[x]), c[x]);
    least_[is_down(0) ? 0 : static_cast<std::size_t>(n_[0])] = kFarthest;
    along_x(empty_ + start_of(y, z), to_ + start_of(y, z));
  }

  /// A cell's own index in least_ and the next are x and x + 1, or the other way round.
  void along_x(const std::uint8_t* empty, std::uint8_t* to) {
    constexpr std::uint8_t kLastStep = kFarthest - 1;
    for (std::ptrdiff_t x = 0; x < n_[0]; ++x)
      to[x] = std::min(
          std::min(least_[static_cast<std::size_t>(x)], least_[static_cast<std::size_t>(x) + 1]),
          kLastStep);
    std::uint8_t before = kFarthest;
    const auto step = [&](std::ptrdiff_t x) {
      before = static_cast<std::uint8_t>((std::min(before, to[x]) + 1) & empty[x]);
      to[x] = before;
    };
    if (is_down(0))
      for (std::ptrdiff_t x = 0; x < n_[0]; ++x)
        step(x);
    else
      for (std::ptrdiff_t x = n_[0]; x-- > 0;)
        step(x);
  }

  const std::uint8_t* const empty_;  ///< 0: occupied, or 255
  std::uint8_t* const to_;
  const std::ptrdiff_t n_[3];
  const std::size_t octant_;
  const std::vector<std::uint8_t> nothing_;
  std::vector<std::uint8_t> least_;  ///< of the three rows on the way of one
};

void take_min(const std::uint8_t* from, std::uint8_t* to, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i)
    to[i] = std::min(to[i], from[i]);
}

/// One octant after the other, for want of memory.
void find_in_all_directions(std::vector<std::uint8_t>& d,
                            const std::array<std::uint32_t, 3>& cells) {
  const std::size_t count = cell_count(cells);
  const std::vector<std::uint8_t> empty = d;
  std::vector<std::uint8_t> octant(count);
  for (std::size_t o = 0; o < kOctants; ++o) {
    OctantSweep(empty.data(), octant.data(), cells, o).run();
    take_min(octant.data(), d.data(), count);
  }
}

}  // namespace

void compute_distances(std::vector<std::uint8_t>& d,
                       const std::array<std::uint32_t, 3>& cells,
                       std::size_t fields,
                       int threads) {
  if (fields == 1)
    return find_in_all_directions(d, cells);
  const std::size_t count = cell_count(cells);
  const auto field = [&](std::size_t octant) { return d.data() + (1 + octant) * count; };
  each_turn(kOctants, threads, [&](std::size_t octant) {
    OctantSweep(d.data(), field(octant), cells, octant).run();
  });
  const std::size_t slice = std::size_t{cells[0]} * cells[1];
  each_turn(cells[2], threads, [&](std::size_t z) {
    for (std::size_t octant = 0; octant < kOctants; ++octant)
      take_min(field(octant) + z * slice, d.data() + z * slice, slice);
  });
}

std::vector<std::uint8_t> distance_transform(const std::vector<std::uint8_t>& occupied,
                                             const std::array<std::uint32_t, 3>& cells,
                                             std::size_t fields) {
  std::vector<std::uint8_t> d(fields * cell_count(cells) + 3);
  for (std::size_t c = 0; c < occupied.size(); ++c)
    d[c] = occupied[c] ? 0 : kFarthest;
  compute_distances(d, cells, fields, 1);
  return d;
}

}  // namespace grelha
