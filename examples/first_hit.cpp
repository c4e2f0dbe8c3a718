#include <cstdio>
#include <grelha/grelha.hpp>

int main() {
  grelha::Scene scene;
  scene.geometry.spheres.add({0, 0, -5}, 1, 0);
  const grelha::World world(scene, {});
  const grelha::Hit hit = grelha::closest(world, {{0, 0, 0}, {0, 0, -1}});
  std::printf("primitive %u at t = %g\n", hit.id, hit.t);
}
