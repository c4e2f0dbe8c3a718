#include "kernel/world/light_grids.hpp"

#include <algorithm>
#include <cmath>
#include <new>

#include "kernel/scene/crew.hpp"
#include "kernel/world/plan.hpp"
#include "kernel/perspective/tolerances.hpp"

namespace grelha {
namespace {

/// Diagonals to the farthest point: doubles still tell 2^20 tiles apart from there.
constexpr double kFarthestPoint = 0x1p21;
/// Bytes of the grids of all lights: 1 KiB a primitive, and 16 MiB.
constexpr std::uint64_t kMostBytesEach = 1 << 10;
constexpr std::uint64_t kMostBytes = 1 << 24;
/// Bytes a primitive of one light: of spheres 42 to 61 were measured, of others 105 to 281.
constexpr std::uint64_t kSphereBytes = 64;
constexpr std::uint64_t kOtherBytes = 256;

/// With fewer, threads wait for each other longer than they work: a millisecond became five.
constexpr std::size_t kPrimitivesAThread = 8192;

std::uint64_t most_bytes_of(const Primitives& primitives) {
  return kMostBytes + kMostBytesEach * primitives.finite_count();
}

}  // namespace

LightGrids::LightGrids(const Primitives& primitives,
                       std::span<const Light> lights,
                       std::span<const std::uint32_t> large,
                       const Box& box,
                       std::uint64_t most_bytes,
                       bool far_rays)
    : primitives_(primitives),
      lights_(lights),
      large_(large.begin(), large.end()),
      box_(box),
      most_bytes_(std::min(most_bytes, most_bytes_of(primitives))),
      far_rays_(far_rays),
      tried_(lights.size()),
      built_(lights.size()) {}

std::uint64_t LightGrids::expected_bytes(const Primitives& primitives, std::size_t lights) {
  const std::uint64_t spheres = primitives.of<Sphere>().size();
  const std::uint64_t others = primitives.finite_count() - spheres;
  return std::min(most_bytes_of(primitives),
                  lights * (kSphereBytes * spheres + kOtherBytes * others));
}

std::unique_ptr<ViewedGrid> LightGrids::build(const Float3& point,
                                              int threads,
                                              const LookLoops& loops) const {
  const double diagonal = box_.diagonal();
  const Viewpoint from{
      {point.x, point.y, point.z},
      (far_rays_ ? kFarPads : kNearPads) * pad_of(diagonal),
      (far_rays_ ? kFarAside : kNearAside) * pad_of(diagonal),
  };
  for (int a = 0; a < 3; ++a)
    if (!(std::abs(from.at[a] - box_.lo[a]) < kFarthestPoint * diagonal))
      return nullptr;
  const StretchesFollow awake;
  const std::vector<std::uint32_t> ids = sound_ids(primitives_);
  std::optional<PerspectiveGrid> grid =
      build_perspective_grid(primitives_, ids, large_, from, {.loops = loops, .threads = threads});
  if (!grid)
    return nullptr;
  auto built = std::make_unique<ViewedGrid>();
  built->grid = std::move(*grid);
  built->view = built->grid.view();
  return built;
}

std::unique_ptr<ViewedGrid> LightGrids::try_to_build(const Light& light,
                                                     int threads,
                                                     const LookLoops& loops) const {
  if (light.is_area() || bytes_ + expected_bytes(primitives_, 1) > most_bytes_)
    return nullptr;
  const int useful = 1 + static_cast<int>(primitives() / kPrimitivesAThread);
  std::unique_ptr<ViewedGrid> built;
  try {
    built = build(light.position, std::min(threads, useful), loops);
  } catch (const std::bad_alloc&) {  // rays then walk, which takes no memory
  }
  return built && bytes_ + built->grid.bytes() <= most_bytes_ ? std::move(built) : nullptr;
}

const PointGridView* LightGrids::of(std::size_t light, int threads, const LookLoops& loops) {
  const std::lock_guard lock(mutex_);
  std::unique_ptr<ViewedGrid>& built = built_[light];
  if (!tried_[light]) {
    tried_[light] = true;
    built = try_to_build(lights_[light], threads, loops);
    bytes_ += built ? built->grid.bytes() : 0;
  }
  return built ? &built->view : nullptr;
}

std::size_t LightGrids::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

}  // namespace grelha
