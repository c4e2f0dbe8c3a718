#pragma once
// What a grelha_world is.

#include <cstddef>
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
/// How its rays are traced.
inline QueryOptions options_of(const grelha_world* world, int threads) {
  return {.threads = expect_threads(threads), .mask = world->masks()};
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
    const BuildOptions options{.threads = expect_threads(threads)};
    *world = std::make_unique<grelha_world>(std::move(scene), options).release();
  });
}

}  // namespace grelha::c
