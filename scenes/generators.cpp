#include "scenes/generators.hpp"

#include <algorithm>
#include <array>

namespace grelha::scenes {

namespace {

constexpr std::array kGenerators{
    Generator{"balls",
              "sphereflake: mirroring spheres that carry nine smaller ones each",
              1,
              7,
              4,
              write_balls,
              nullptr,
              true},
    Generator{"mount",
              "fractal mountain of triangles under four balls of glass",
              1,
              11,
              7,
              write_mount,
              nullptr,
              true},
    Generator{"distant",
              "balls in a row that leads away from a camera with a lens",
              1,
              100,
              3,
              write_distant},
    Generator{"boat",
              "sailing boat between three mirrors, a scene and a PLY file",
              4,
              40,
              10,
              write_boat,
              write_boat_mesh},
    Generator{
        "stadium", "fine knot on a ground a thousand times its size", 1, 40, 6, write_stadium},
    Generator{"knot",
              "knot of brass and a ball of glass, a scene and a PLY file",
              1,
              40,
              8,
              write_knot,
              write_knot_mesh},
    Generator{"terrain",
              "land of as many triangles as wanted, a scene and a binary PLY file",
              1,
              250,
              20,
              write_terrain,
              write_terrain_mesh},
    Generator{"tetra", "tetrahedral pyramid of triangles", 1, 10, 6, write_tetra},
    Generator{"gears", "meshing gears of concave 144-gons, some of glass", 1, 10, 4, write_gears},
    Generator{"rings", "pyramid of interlocked rings of rods and balls", 1, 40, 7, write_rings},
    Generator{"tree", "tree of cones and spheres under seven lights", 0, 16, 11, write_tree},
    Generator{"lattice", "cube of balls joined by rods", 1, 50, 12, write_lattice},
    Generator{"discs", "discs far smaller than a pixel, each within one", 1, 512, 64, write_discs},
    Generator{"awning", "plates that throw soft shadows a pixel wide", 1, 500, 64, write_awning},
    Generator{"star", "Siemens star: edges at every angle", 2, 1000, 36, write_star},
};

}  // namespace

std::span<const Generator> generators() {
  return kGenerators;
}

const Generator* find_generator(std::string_view name) {
  const auto found = std::ranges::find(kGenerators, name, &Generator::name);
  return found == kGenerators.end() ? nullptr : &*found;
}

}  // namespace grelha::scenes
