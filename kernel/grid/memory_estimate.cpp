#include "kernel/grid/plan.hpp"

#include <algorithm>
#include <array>

#include "kernel/base/raw_vector.hpp"
#include "kernel/grid/cell_finder.hpp"
#include "kernel/grid/distance_field.hpp"
#include "kernel/scene/shading_view.hpp"

namespace grelha {
namespace {

constexpr std::size_t kProbes = 16384;
/// bytes while lists are written: a cell and an id; an id
constexpr double kPair = 8;
constexpr double kId = 4;
/// a block of triangles in a list, and in a grid
constexpr double kListed = ListStore<Triangle>::kEntry;
/// positions of boxes a block: 1.14 to 1.27 on scans, a mountain and gears
constexpr double kPlaces = 1.2;
constexpr double kRow = sizeof(BlockBoxes) + sizeof(std::uint32_t);
constexpr double kBoxed = kListed + kPlaces * kRow / kBlock;
constexpr double kMaterial = sizeof(float) * kMaterialFields;  ///< prepared
constexpr auto kTriangles = kNumber<Triangle>;

/// The size of lists: references by kind, and blocks of triangles.
struct Lists {
  std::array<double, kKinds> references{};
  double blocks = 0;
  double cells = 0;  ///< that hold something
  double all() const {
    double sum = 0;
    for (const double n : references)
      sum += n;
    return sum;
  }
  double bytes(double block) const {
    double sum = blocks * block;
    for_each_finite_shape([&]<class Shape>() {
      using Store = ListStore<Shape>;
      if (!Shape::kInBlocks)
        sum += references[kNumber<Shape>] * double{Store::kEntry};
    });
    return sum;
  }
};

/// At random, since neighbours in a file are neighbours in space; ascending, none twice.
std::vector<std::uint32_t> pick(const std::vector<std::uint32_t>& ids) {
  if (ids.size() <= kProbes)
    return ids;
  std::vector<std::uint32_t> picked;
  std::uint64_t state = 1;
  for (std::size_t i = 0; i < kProbes; ++i) {
    state = state * 6364136223846793005u + 1442695040888963407u;  // Knuth's MMIX
    picked.push_back(ids[(state >> 32) * ids.size() >> 32]);
  }
  std::sort(picked.begin(), picked.end());
  picked.erase(std::unique(picked.begin(), picked.end()), picked.end());
  return picked;
}

/// Cells that hold references, and what blocks of eight each takes if they are triangles.
struct HeldCells {
  double cells, blocks;
};

/// Where picked references, `share` of all, stand in `cells`.
HeldCells held_cells(double references, std::vector<std::size_t> cells, double share) {
  if (cells.empty())
    return {};
  std::sort(cells.begin(), cells.end());
  double pairs = 0;
  for (auto from = cells.begin(), to = from; from != cells.end(); from = to) {
    to = std::upper_bound(from, cells.end(), *from);
    pairs += static_cast<double>(to - from) * static_cast<double>(to - from - 1);
  }
  // References that the mean one shares its cell with, itself counted: the sum of squares over the
  // sum. Cells of a surface hold from nothing to twice the mean, so there are half as many again as
  // if all held as much. The last block of each is half empty, or an eighth full.
  const double held = 1 + pairs / (share * static_cast<double>(cells.size()));
  const double count = references * 1.5 / (held + .5);
  return {count, references / kBlock + count * (1 + 1 / held) * 7 / 16};
}

Lists expected(const Primitives& p, const std::vector<std::uint32_t>& ids, const Grid& g) {
  const std::vector<std::uint32_t> picked = pick(ids);
  const CellFinder finder(p, g);
  Lists lists;
  std::vector<std::size_t> of_all, of_triangles;  // cells
  for (const std::uint32_t id : picked)
    finder(id, [&](std::size_t cell) {
      const PrimitiveKind kind = p.kind_of(id);
      ++lists.references[static_cast<std::size_t>(kind)];
      of_all.push_back(cell);
      if (kind == PrimitiveKind::kTriangle)
        of_triangles.push_back(cell);
    });
  const double share = static_cast<double>(picked.size()) / static_cast<double>(ids.size());
  for (double& n : lists.references)
    n /= share;
  lists.blocks = held_cells(lists.references[kTriangles], std::move(of_triangles), share).blocks;
  lists.cells = std::min(held_cells(lists.all(), std::move(of_all), share).cells,
                         static_cast<double>(cell_count(g.cells)));
  return lists;
}

double ids_bytes(const std::vector<std::uint32_t>& ids) {
  return kId * static_cast<double>(ids.size());
}

double ids_bytes(const Plan& plan) {
  double sum = ids_bytes(plan.ungridded);
  for (const GridPlan& part : plan.parts)
    sum += ids_bytes(part.ids.list);
  return sum;
}

double setup_bytes(const Primitives& p) {
  double sum = 0;
  for_each_shape([&]<class Shape>() {
    sum += double{Shape::Source::kSetupBytes} * static_cast<double>(p.of<Shape>().size());
  });
  return sum;
}

/// The list of primitives without a grid, as one cell.
Lists of_outside(const Primitives& p, const Plan& plan) {
  Lists lists;
  for (const std::uint32_t id : plan.ungridded)
    ++lists.references[static_cast<std::size_t>(p.kind_of(id))];
  lists.blocks = lists.references[kTriangles] / kBlock + 1;
  return lists;
}

double fields_of(double cells) {
  return static_cast<double>(distance_fields(static_cast<std::size_t>(cells)));
}

/// Bytes of the last large page of blocks that nothing fills.
double unused_bytes(double blocks) {
  const auto count = static_cast<std::size_t>(blocks);
  return static_cast<double>(RawAllocator<TriangleBlock>::bytes_for(count) -
                             count * sizeof(TriangleBlock));
}

/// Bytes as a build goes on.
struct Memory {
  double kept = 0;     ///< by what is built so far
  double waiting = 0;  ///< ids of the primitives still to be built
  double peak = 0;

  /// Raises the peak by what is being built, and by what that takes besides for a while.
  void raise(double own, double besides) { peak = std::max(peak, kept + own + waiting + besides); }

  /// A grid of so many cells.
  void add(const Lists& lists, double cells) {
    const double distances = fields_of(cells) * cells;
    double own = distances + lists.bytes(kBoxed) + unused_bytes(lists.blocks) +
                 static_cast<double>(box_level_bytes(static_cast<std::size_t>(lists.cells)));
    for (const double n : lists.references)
      own += n > 0 ? kId * cells : 0;
    // the pairs, then two fields besides where there is one
    raise(own, std::max(kPair * lists.all(), distances > cells ? 0 : 2 * cells));
    kept += own;
  }
};

}  // namespace

BuildMemory memory_of(const SceneSpans& scene, const Primitives& p, const Plan& plan) {
  Memory m;
  m.kept = kMaterial * static_cast<double>(scene.materials.size()) + setup_bytes(p);
  m.waiting = ids_bytes(plan);
  for (const GridPlan& part : plan.parts) {
    m.add(expected(p, part.ids.list, part.grid), static_cast<double>(cell_count(part.grid.cells)));
    m.waiting -= ids_bytes(part.ids.list);
  }
  const Lists outside = of_outside(p, plan);
  const double listed = outside.bytes(kListed);
  m.raise(listed, (kPair + kId) * outside.all());
  return {static_cast<std::uint64_t>(m.peak), static_cast<std::uint64_t>(m.kept + listed)};
}

bool surely_fits(const Primitives& p, std::uint64_t bytes) {
  constexpr double kReferencesOfOne = 64;  // as in grid.cpp
  return kReferencesOfOne * (kPair + kBoxed) * static_cast<double>(p.finite_count()) <
         static_cast<double>(bytes);
}

}  // namespace grelha
