// The kernel in a program of one's own. With grelha installed:  cmake -S examples -B build && cmake
// --build build && build/embed
#include <grelha/grelha.hpp>

#include <algorithm>
#include <cstdio>
#include <vector>

namespace {

/// One ray: what does it meet first? Another, from the surface it met: is anything in its way?
void ask_one_ray(const grelha::World& world) {
  const grelha::Ray ray{{0, 0, 5}, {0, 0, -1}};
  const grelha::Hit hit = grelha::closest(world, ray);
  const grelha::Float3 up = {0, 1, 0}, from = grelha::surface(world, ray, hit).start(up);
  std::printf("sphere %u at t = %g, %s\n",
              grelha::primitive_of(world, hit.id).index,
              hit.t,
              occluded(world, {from, up}) ? "shaded" : "lit");
}

/// A stream of rays, any number of them, from any thread.
void ask_streams(const grelha::World& world) {
  std::vector<grelha::Ray> rays(1000);
  std::vector<grelha::Hit> hits(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i)
    rays[i] = {{-2 + .004f * float(i), 0, 5}, {0, 0, -1}};
  grelha::closest(world, rays, hits);
  std::size_t met = 0;
  for (const grelha::Hit& hit : hits)
    met += bool(hit);
  std::printf("%zu of %zu rays meet something\n", met, rays.size());

  // Points x y z x y z are read where they lie; here one direction serves all.
  std::vector<float> points;
  for (const grelha::Ray& ray : rays)
    points.insert(points.end(), {ray.org.x, ray.org.y, ray.org.z});
  const float ahead[] = {0, 0, -1};
  const grelha::Rays view{.org = {&points[0], &points[1], &points[2]},
                          .dir = {&ahead[0], &ahead[1], &ahead[2]},
                          .count = rays.size(),
                          .org_stride = 3,
                          .dir_stride = 0};
  std::vector<std::uint8_t> blocked(rays.size());
  grelha::occluded(world, view, blocked.data());
  std::printf("%td of them are blocked\n", std::count(blocked.begin(), blocked.end(), 1));
}

/// A picture, with progress; returning false would cancel it.
void draw(const grelha::World& world) {
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

}  // namespace

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
  ask_one_ray(world);
  ask_streams(world);
  draw(world);
}
