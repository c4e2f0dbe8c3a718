#pragma once
// What a grelha_world is.

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

}  // namespace grelha::c
