#include "scenes/generators.hpp"

#include <algorithm>
#include <array>

namespace grelha::scenes {

namespace {

constexpr std::array kGenerators{
    Generator{"balls", "sphereflake: mirroring spheres that carry nine smaller ones each", 1, 7, 4, write_balls},
    Generator{"mount", "fractal mountain of triangles under four balls of glass", 1, 10, 7, write_mount},
};

}  // namespace

std::span<const Generator> generators() { return kGenerators; }

const Generator* find_generator(std::string_view name) {
  const auto found = std::ranges::find(kGenerators, name, &Generator::name);
  return found == kGenerators.end() ? nullptr : &*found;
}

}  // namespace grelha::scenes
