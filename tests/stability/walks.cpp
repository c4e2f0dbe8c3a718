// Tests for hits that acceleration structures miss: rays on cell borders, unusual directions,
// unusual numbers, unusual scenes. The reference is brute force in long double over the same
// floats, so a row fails if a grid or a tree skips a primitive as well as if an intersection test
// is wrong.
#include <algorithm>
#include <cmath>

#include "tests/stability/rows.hpp"
#include "tests/support/cell_rays.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::stability {
namespace {

using namespace test;

void judge_all(Trial& trial, const RayList& rays) {
  const Size size = size_of(trial.scene);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (rays.dir(i) == Float3{})
      continue;
    trial.add(rays.org(i), rays.dir(i), brute_force(trial.scene, size, rays.org(i), rays.dir(i)));
  }
}

/// In planes between cells, along their edges, through their corners, down their diagonals: the
/// cells of Grelha's own grid.
void on_cells(Random& random, std::size_t rays, const Sink& sink) {
  for (const bool lattice : {false, true}) {
    Trial trial;
    trial.scene = lattice ? lattice_patch(6) : balls_and_triangles(random.next(), 100);
    const World world(trial.scene, {});
    judge_all(trial, rays_on_cells(random, world, static_cast<int>(rays / 2)));
    sink(trial);
  }
}

/// Along axes, with zeros of both signs or a denormal beside; of any length up to so many powers of
/// ten from 1.
template <int kExponent>
void odd_directions(Random& random, std::size_t rays, const Sink& sink) {
  Trial trial;
  trial.scene = balls_and_triangles(random.next(), 100);
  RayList list;
  for (std::size_t i = 0; i < rays; ++i) {
    const Float3 aim = random.point(1);
    Float3 dir = random.direction();
    const std::uint32_t a = random.below(3);
    const double kind = random.unit();
    for (std::uint32_t b = 0; b < 3; ++b)
      if (kind < .4 ? b != a : kind < .7 && b == a)
        component(dir, b) =
            random.chance(.5) ? random.zero() : static_cast<float>(random.sign() * 1e-40);
    const Float3 org = at(aim, -random.log_in(.1, 10), dir);
    const Float3 d =
        scaled(dir, random.log_in(std::pow(10., -kExponent), std::pow(10., kExponent)));
    const double length = std::hypot(double(d.x), double(d.y), double(d.z));
    // beyond these no directions are promised to be traced
    if (length > 2e-18 && length < 5e17)
      list.add(org, d);
  }
  judge_all(trial, list);
  sink(trial);
}

/// A third of the rays have a NaN or an infinity somewhere; their neighbours in a packet must not
/// feel it.
void unsound_rays(Random& random, std::size_t rays, const Sink& sink) {
  Trial trial;
  trial.scene = balls_and_triangles(random.next(), 100);
  const Size size = size_of(trial.scene);
  for (std::size_t i = 0; i < rays; ++i) {
    Float3 org = at({0, 0, 0}, random.log_in(.1, 10), random.direction()),
           dir = minus(random.point(1), org);
    if (!random.chance(1. / 3)) {
      trial.add(org, dir, brute_force(trial.scene, size, org, dir));
      continue;
    }
    const float odd[] = {kNaN, kInf, -kInf, 3e38f};
    component(random.chance(.5) ? org : dir, random.below(3)) = odd[random.below(4)];
    Expected w;
    w.miss = true;
    w.traces = false;
    trial.add(org, dir, w);
  }
  sink(trial);
}

template <Scene (*kMake)(Random&)>
void scene_of(Random& random, std::size_t rays, const Sink& sink) {
  Trial trial;
  trial.scene = kMake(random);
  const Size size = size_of(trial.scene);
  const double reach = size.diagonal > 0 ? size.diagonal / 2 : 1;
  judge_all(trial, rays_about(random, {}, reach, static_cast<int>(rays), 1e3));
  sink(trial);
}

Scene flat(Random& random) {
  Scene s = flat_sheet(random.next(), 100);
  for (float& y : s.geometry.triangles.y)
    y = 0;
  return s;
}
Scene single(Random& random) {
  return one_triangle(random.point(1), random.point(1), random.point(1));
}
Scene nothing(Random&) {
  return empty_scene();
}
// a teapot in a stadium: a body of 1e-4 of the ground and stands about it
Scene crowded_cell(Random& random) {
  Scene s = empty_scene();
  add_triangles(s, random, 80, 1, .02, .1);
  for (int i = 0; i < 40; ++i) {
    const Float3 foot = at({0, 0, 0}, 9000, random.direction());
    add_triangle(s, foot, at(foot, 2000, random.direction()), at(foot, 2500, random.direction()));
  }
  return s;
}
Scene diagonals(Random& random) {
  Scene s = empty_scene();
  for (int i = 0; i < 100; ++i) {
    const Float3 a = random.point(.05), b = random.point(.05);
    add_triangle(s,
                 {a.x - 1, a.y - 1, a.z - 1},
                 {b.x + 1, b.y + 1, b.z + 1},
                 at({b.x + 1, b.y + 1, b.z + 1}, 1e-3, random.direction()));
  }
  return s;
}

/// So many copies of one triangle and one sphere: what is hit must be there, and the search must
/// end.
void copies(Random& random, std::size_t rays, const Sink& sink) {
  const std::size_t count = std::clamp<std::size_t>(rays / 2, 500, 500000);
  Trial trial;
  trial.scene = empty_scene();
  const Float3 a = random.point(1), b = random.point(1), c = random.point(1);
  for (std::size_t i = 0; i < count; ++i)
    add_triangle(trial.scene, a, b, c), trial.scene.geometry.spheres.add({2, 2, 2}, .5f, 0);
  Scene one = one_triangle(a, b, c);
  one.geometry.spheres.add({2, 2, 2}, .5f, 0);
  const Size size = size_of(one);
  const RayList list =
      rays_about(random,
                 {1, 1, 1},
                 1.5,
                 static_cast<int>(std::clamp<std::size_t>(200000000 / count / 4, 16, 1000)),
                 1e3);
  for (std::size_t i = 0; i < list.size(); ++i)
    if (list.dir(i) != Float3{})
      trial.add(list.org(i), list.dir(i), brute_force(one, size, list.org(i), list.dir(i)));
  sink(trial);
}

/// A grid of one cell an axis, and one of 1024 along the only axis there is.
void bounds_of_resolution(Random& random, std::size_t rays, const Sink& sink) {
  for (const float density : {1e-3f, 1e3f}) {
    Trial trial;
    trial.density = density;
    trial.scene = empty_scene();
    for (int i = 0; i < 100; ++i)
      add_triangle(trial.scene, {float(i), 0, 0}, {i + .9f, 1e-2f, 0}, {float(i), 0, 1e-2f});
    RayList list;
    for (std::size_t i = 0; i < rays / 2; ++i) {
      const Float3 aim{static_cast<float>(random.in(0, 100)), 5e-3f, 2e-3f},
          org = at(aim, random.log_in(.01, 100), random.direction());
      list.add(org, minus(aim, org));
    }
    judge_all(trial, list);
    sink(trial);
  }
}

/// Three corners and a centre are no numbers: those primitives are not there, and all others are.
void unsound_vertices(Random& random, std::size_t rays, const Sink& sink) {
  Trial trial;
  trial.scene = balls_and_triangles(random.next(), 100);
  Scene sound = trial.scene;
  const float odd[] = {kNaN, kInf, -kInf};
  for (std::uint32_t i = 3; i-- > 0;) {
    const std::uint32_t k = 10 * i + random.below(10);
    trial.scene.geometry.triangles.x[3 * k + i] = odd[i];
    for (auto* v :
         {&sound.geometry.triangles.a, &sound.geometry.triangles.b, &sound.geometry.triangles.c})
      v->erase(v->begin() + k);
  }
  trial.scene.geometry.spheres.x[7] = kNaN;
  Spheres& balls = sound.geometry.spheres;
  for (auto* v : {&balls.x, &balls.y, &balls.z, &balls.radius})
    v->erase(v->begin() + 7);
  const Size size = size_of(trial.scene);
  const RayList list = rays_about(random, {}, 1, static_cast<int>(rays), 10);
  for (std::size_t i = 0; i < list.size(); ++i)
    if (list.dir(i) != Float3{})
      trial.add(list.org(i), list.dir(i), brute_force(sound, size, list.org(i), list.dir(i)));
  sink(trial);
}

}  // namespace

std::vector<Row> walk_rows() {
  const char* const truth = "brute force in long double";
  return {
      {"rays on cells",
       "in planes between cells, along edges, through corners, down diagonals",
       truth,
       on_cells},
      {"odd directions",
       "along axes, -0, denormals, lengths 1e-3 to 1e3",
       truth,
       odd_directions<3>},
      {"directions of any length", "the same, 1e-17 to 1e17", truth, odd_directions<17>},
      {"rays of NaN and infinity",
       "a third of the rays",
       "they meet nothing, their neighbours what they should",
       unsound_rays},
      {"flat scene", "no extent along y", truth, scene_of<flat>},
      {"one triangle", "", truth, scene_of<single>},
      {"no primitive", "", "nothing is met", scene_of<nothing>},
      {"copies of one primitive",
       "up to half a million of a triangle and a sphere each",
       truth,
       copies},
      {"all in one cell",
       "80 triangles of .1 in a ring of 40, 18,000 across",
       truth,
       scene_of<crowded_cell>},
      {"long thin diagonals", "100 triangles 3.5 long and .001 wide", truth, scene_of<diagonals>},
      {"corners of NaN and infinity",
       "three triangles and a sphere among 100",
       "they are not there, all others are",
       unsound_vertices},
      {"resolution at its bounds", "one cell an axis; 1024 along one", truth, bounds_of_resolution},
  };
}

}  // namespace grelha::stability
