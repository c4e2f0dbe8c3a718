#include "kernel/grid/light_grids.hpp"

#include <algorithm>
#include <cmath>
#include <new>

#include "kernel/grid/plan.hpp"
#include "kernel/perspective/tolerances.hpp"

namespace grelha {
namespace {

/// Diagonals to the farthest point: doubles still tell 2^20 tiles apart from there.
constexpr double kFarthestPoint = 0x1p21;
/// Bytes of the grids of all lights: 1 KiB a primitive, and 16 MiB.
constexpr std::size_t kMostBytesEach = 1 << 10;
constexpr std::size_t kMostBytes = 1 << 24;

/// With fewer, threads wait for each other longer than they work: a millisecond became five.
constexpr std::size_t kPrimitivesAThread = 8192;

}  // namespace

LightGrids::LightGrids(const Primitives& primitives,
                       std::span<const Light> lights,
                       std::span<const std::uint32_t> large,
                       const Box& box)
    : primitives_(primitives),
      lights_(lights),
      large_(large.begin(), large.end()),
      box_(box),
      built_(lights.size()) {}

std::unique_ptr<ViewedGrid> LightGrids::build(const Float3& point, int threads) const {
  const double diagonal = box_.diagonal();
  const Viewpoint from{
      {point.x, point.y, point.z},
      kPads * pad_of(diagonal),
  };
  for (int a = 0; a < 3; ++a)
    if (!(std::abs(from.at[a] - box_.lo[a]) < kFarthestPoint * diagonal))
      return nullptr;
  auto built = std::make_unique<ViewedGrid>();
  const std::vector<std::uint32_t> ids = sound_ids(primitives_);
  built->grid = build_perspective_grid(primitives_, ids, large_, from, {.threads = threads});
  built->view = built->grid.view();
  return built;
}

const PointGridView* LightGrids::of(std::size_t light, int threads) {
  const std::lock_guard lock(mutex_);
  if (!built_[light]) {
    if (lights_[light].is_area() || bytes_ > kMostBytes + kMostBytesEach * primitives())
      return nullptr;
    try {
      const int useful = 1 + static_cast<int>(primitives() / kPrimitivesAThread);
      built_[light] = build(lights_[light].position, std::min(threads, useful));
    } catch (const std::bad_alloc&) {  // rays then walk, which takes no memory
    }
    if (!built_[light])
      return nullptr;
    bytes_ += built_[light]->grid.bytes();
  }
  return &built_[light]->view;
}

std::size_t LightGrids::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

}  // namespace grelha
