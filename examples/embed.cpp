// The kernel in a program of one's own. With grelha installed:  cmake -S examples -B build && cmake
// --build build && build/embed
#include <grelha/grelha.hpp>

#include <cstdio>

int main() {
  // Geometry stands in the caller's own arrays, one per component: no copy is made of them.
  const float x[] = {-1, 0, 1}, y[] = {0, 0, 0}, z[] = {0, 1, 0}, radius[] = {.6f, .8f, .6f};
  const std::uint32_t material[] = {0, 1, 0};
  // dull red, a mirror
  const grelha::Material materials[] = {{{.8f, .3f, .2f}}, {{.1f, .1f, .1f}, {}, {.8f, .8f, .8f}}};
  const grelha::Light lights[] = {{{5, 5, 9}, {1, 1, 1}}};
  grelha::SceneSpans scene;
  scene.geometry.spheres.x = x;
  scene.geometry.spheres.y = y;
  scene.geometry.spheres.z = z;
  scene.geometry.spheres.radius = radius;
  scene.geometry.spheres.material = material;
  scene.materials = materials;
  scene.lights = lights;
  scene.background = {.2f, .3f, .5f};
  const grelha::World world(scene, {});

  // One ray: what does it meet first? Another, from the surface it met: is anything in its way?
  const grelha::Ray ray{{0, 0, 5}, {0, 0, -1}};
  const grelha::Hit hit = grelha::closest(world, ray);
  const grelha::Float3 up = {0, 1, 0}, from = grelha::surface(world, ray, hit).leave(up);
  std::printf("sphere %u at t = %g, %s\n",
              grelha::primitive_of(world, hit.id).index,
              hit.t,
              occluded(world, {from, up}) ? "shaded" : "lit");

  // A stream of rays in arrays, any number of them, from any thread.
  constexpr int kRays = 1000;
  float start[kRays], zero[kRays] = {}, five[kRays], ahead[kRays], t[kRays];
  std::uint32_t id[kRays];
  for (int i = 0; i < kRays; ++i) {
    start[i] = -2 + .004f * float(i);
    five[i] = 5;
    ahead[i] = -1;
    t[i] = 100;
  }
  grelha::closest(world, {start, zero, five, zero, zero, ahead, zero, t, id, kRays});
  int met = 0;
  for (const std::uint32_t i : id)
    met += i != grelha::kNoPrimitive;
  std::printf("%d of %d rays meet something\n", met, kRays);

  // A picture, with progress; returning false would cancel it.
  grelha::RenderOptions options;
  options.progress = [](double share) { return share <= 1; };
  grelha::RenderStats stats;
  const grelha::Camera camera{{0, 1, 6}, {0, 0, 0}, {0, 1, 0}, 40, 160, 120};
  const grelha::Image image = grelha::render(world, camera, options, stats);
  std::printf("%dx%d, %llu rays by %s\n",
              image.width,
              image.height,
              static_cast<unsigned long long>(stats.rays.total()),
              stats.isa);
}
