#pragma once
// What a grelha_world is.

#include <algorithm>
#include <cstddef>
#include <functional>
#include <memory>
#include <utility>

#include "c/errors.hpp"
#include "grelha/owning_world.hpp"
#include "grelha/query.hpp"

struct grelha_world : grelha::OwningWorld {
  using OwningWorld::OwningWorld;
};

namespace grelha::c {

/// The world to ask. Throws std::invalid_argument for null.
inline const World& world_of(const grelha_world* world) {
  expect_there(world, "world");
  return world->world();
}
/// Elements [first, end) of a stream of `count`, which one call of the kernel works on.
struct Part {
  std::size_t first = 0, end = 1, count = 1;
};
/// What calls the function of grelha_set_progress() of this thread, if there is one, with the
/// fraction done of a whole stream.
std::function<bool(double)> progress_of(Part part = {});

/// How the rays of a world are traced.
inline QueryOptions options_of(const grelha_world* world, int threads, Part part = {}) {
  return {
      .threads = expect_threads(threads), .mask = world->masks(), .progress = progress_of(part)};
}
/// How a world is built.
inline BuildOptions build_options(int threads) {
  return {.threads = expect_threads(threads), .progress = progress_of()};
}

/// Floats from one element to the next; 0 where all rays share one. Throws std::invalid_argument.
std::ptrdiff_t floats_of(std::ptrdiff_t stride, std::size_t count, const char* name);
/// Throws std::invalid_argument for null and for an address that no float has.
void expect_floats(const float* array, const char* name);
/// The rays of a caller. Throws std::invalid_argument.
Rays rays_of(const grelha_rays* rays);

/// Calls work(first, end) for parts of a stream, so that what is copied is in memory twice only in
/// part.
template <class Work>
void each_part(std::size_t count, std::size_t most, const Work& work) {
  for (std::size_t first = 0; first < count; first += most)
    work(Part{first, std::min(count, first + most), count});
}

inline constexpr std::size_t kMostPrimitives = 0xFFFFFFFEu;
inline constexpr std::size_t kMostVertices = std::size_t{1} << 32;

/// Stores a world of the scene that make() makes, null if anything throws.
template <class Make>
grelha_status make_world(grelha_world** world, int threads, const Make& make) noexcept {
  if (world)
    *world = nullptr;
  return guarded([&] {
    expect_there(world, "world");
    OffsetScene scene = make();
    *world = std::make_unique<grelha_world>(std::move(scene), build_options(threads)).release();
  });
}

}  // namespace grelha::c
