// Scenes whose vertices all move from frame to frame, or those of one mesh of many: the time of an
// update and of 256 x 256 camera rays, beside Embree of quality LOW, MEDIUM and REFIT. One thread;
// the methods take turns.
//
// update [--scene NAME]... [--frames N]
//
// A scene is a file, `GENERATOR SIZE`, `balls`, `meshes N` (N meshes of 1520 triangles, of which
// the one in the middle moves alone) or `ground N` (one alone moves over a ground of 2 N^2).
//
// Prints a table of Markdown: milliseconds a frame, the median. Grelha: World::update() and one
// stream of rays. Embree (robust): a commit after the vertices are copied, and its fastest way of
// tracing. A vertex moves along a wave of a tenth of the scene's width; each ball by itself.

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "perf/embree.hpp"
#include "perf/timing.hpp"
#include "perf/workloads.hpp"
#include "tests/support/random.hpp"
#include "tests/support/scenes.hpp"

namespace {

using namespace grelha;
using namespace grelha::perf;

constexpr std::size_t kBalls = 10'000;
constexpr const char* kNames[] = {"Grelha", "Embree LOW", "Embree MEDIUM", "Embree REFIT"};
constexpr int kMethods = 4;

/// Times of one method: of updates and of rays.
struct Times {
  std::vector<double> update, rays;
};

template <class Work>
double milliseconds(const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
  return took.count();
}

/// Balls at random in a cube, seen from outside it.
SceneFile balls() {
  SceneFile file;
  test::Random random(1);
  file.scene.materials.emplace_back();
  for (std::size_t i = 0; i < kBalls; ++i)
    file.scene.geometry.spheres.add(random.point(1), static_cast<float>(random.in(.01, .03)), 0);
  file.camera.eye = {2.5f, 1.5f, 2};
  file.camera.at = {0, 0, 0};
  file.camera.up = {0, 1, 0};
  return file;
}

/// Bodies side by side, each an object, seen from above.
SceneFile meshes(int count) {
  SceneFile file;
  file.scene.materials.emplace_back();
  const int side = static_cast<int>(std::ceil(std::sqrt(count)));
  for (int i = 0; i < count; ++i) {
    const auto before = file.scene.geometry.triangles.x.size();
    test::add_object(file.scene, test::ball_mesh(40, 20, .1, static_cast<std::uint64_t>(i)));
    Triangles& t = file.scene.geometry.triangles;
    for (std::size_t v = before; v < t.x.size(); ++v) {
      t.x[v] += 2.5f * static_cast<float>(i % side);
      t.z[v] += 2.5f * static_cast<float>(i / side);
    }
  }
  const float middle = 1.25f * static_cast<float>(side);
  file.camera.eye = {middle, 3 * middle, 3 * middle};
  file.camera.at = {middle, 0, middle};
  file.camera.up = {0, 1, 0};
  return file;
}

/// A body over a rough ground of 2 n^2 triangles, seen from above; the body is the first object.
SceneFile over_ground(int n) {
  SceneFile file = meshes(1);
  Triangles& t = file.scene.geometry.triangles;
  const auto first_vertex = static_cast<std::uint32_t>(t.vertex_count());
  const auto first = static_cast<std::uint32_t>(t.size()), row = static_cast<std::uint32_t>(n) + 1;
  test::Random random(1);
  const double step = 20. / n;
  for (int i = 0; i <= n; ++i)
    for (int k = 0; k <= n; ++k) {
      t.x.push_back(static_cast<float>(step * i - 10));
      t.y.push_back(static_cast<float>(random.in(-1.5 - step, -1.5)));
      t.z.push_back(static_cast<float>(step * k - 10));
    }
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    t.a.push_back(first_vertex + a);
    t.b.push_back(first_vertex + b);
    t.c.push_back(first_vertex + c);
    t.material.push_back(0);
  };
  for (std::uint32_t v = 0; v < row * (row - 1); ++v)
    if (v % row != row - 1) {
      add(v, v + 1, v + row + 1);
      add(v, v + row + 1, v + row);
    }
  file.scene.geometry.objects.push_back({first, static_cast<std::uint32_t>(t.size()) - first});
  file.camera.eye = {0, 12, 16};
  file.camera.at = {0, -1, 0};
  return file;
}

/// A scene at each frame.
class Moving {
 public:
  /// One object moves alone, unless it is kAll.
  explicit Moving(const Scene& scene, std::size_t object) : rest_(scene), object_(object) {
    const auto& g = scene.geometry;
    last_ = g.triangles.vertex_count();
    if (object != EmbreeScene::kAll) {
      first_ = 3 * std::size_t{g.objects[object].first_triangle};
      last_ = first_ + 3 * std::size_t{g.objects[object].triangle_count};
    }
    for (const auto* axis : {&g.triangles.x, &g.triangles.y, &g.triangles.z})
      if (!axis->empty()) {
        const auto [lo, hi] = std::minmax_element(axis->begin(), axis->end());
        width_ = std::max(width_, double{*hi} - *lo);
      }
    if (g.triangles.x.empty())
      width_ = 2;
  }
  Scene at(int frame) const {
    Scene s = rest_;
    Triangles& t = s.geometry.triangles;
    for (std::size_t i = first_; i < last_; ++i)
      t.y[i] += static_cast<float>(.1 * width_ * std::sin(5 * t.x[i] / width_ + .3 * frame));
    Spheres& b = s.geometry.spheres;
    test::Random random(7);
    for (std::size_t i = 0; i < b.size(); ++i) {
      const Float3 way = random.direction();
      const double by = .1 * width_ * std::sin(.3 * frame);
      b.x[i] += static_cast<float>(by * way.x);
      b.y[i] += static_cast<float>(by * way.y);
      b.z[i] += static_cast<float>(by * way.z);
    }
    return s;
  }
  void update(World& world, const Scene& scene) const {
    if (object_ == EmbreeScene::kAll)
      world.update(scene, {.threads = 1});
    else
      world.update(scene, {.threads = 1}, {&scene.geometry.objects[object_], 1});
  }

 private:
  const Scene& rest_;
  const std::size_t object_;
  std::size_t first_ = 0, last_ = 0;  ///< vertices that move
  double width_ = 0;
};

/// The fastest way of tracing these rays.
EmbreeMode fastest(EmbreeScene& scene, const RayBuffer& rays) {
  EmbreeMode best{};
  double least = 1e300;
  for (const EmbreeMode& mode : embree_modes())
    for (int i = 0; i < 3; ++i) {
      const double took = milliseconds([&] { scene.trace(rays, false, mode); });
      if (took < least) {
        least = took;
        best = mode;
      }
    }
  return best;
}

void run(const std::string& name, int frames) {
  const bool are_meshes = name.starts_with("meshes "), is_ground = name.starts_with("ground ");
  const int count = are_meshes || is_ground ? std::max(1, std::atoi(name.c_str() + 7)) : 0;
  const std::size_t object = are_meshes  ? static_cast<std::size_t>(count / 2)
                             : is_ground ? 0
                                         : EmbreeScene::kAll;
  SceneFile file = name == "balls" ? balls()
                   : are_meshes    ? meshes(count)
                   : is_ground     ? over_ground(count)
                                   : scene_named(name);
  file.scene.geometry.planes = {};
  file.scene.geometry.cones = {};
  file.camera.width = file.camera.height = 256;
  const Moving moving(file.scene, object);
  const RayBuffer rays = camera_rays(file.camera);
  World world(file.scene, {.threads = 1});
  std::vector<std::unique_ptr<EmbreeScene>> embree;
  std::vector<EmbreeMode> modes;
  for (const MovingScene how : {MovingScene::kLow, MovingScene::kMedium, MovingScene::kRefit})
    if (auto scene = make_moving_embree_scene(file.scene, how)) {
      modes.push_back(fastest(*scene, rays));
      embree.push_back(std::move(scene));
    }
  std::array<Times, kMethods> times;
  Answers answers;
  answers.resize(rays.size(), false);
  for (int frame = 1; frame <= frames; ++frame) {
    const Scene scene = moving.at(frame);
    times[0].update.push_back(milliseconds([&] { moving.update(world, scene); }));
    times[0].rays.push_back(
        milliseconds([&] { ask_in_streams(world, rays, false, rays.size(), {}, answers); }));
    for (std::size_t k = 0; k < embree.size(); ++k) {
      embree[k]->move(scene, object);
      times[k + 1].update.push_back(milliseconds([&] { embree[k]->commit(); }));
      times[k + 1].rays.push_back(milliseconds([&] { embree[k]->trace(rays, false, modes[k]); }));
    }
  }
  std::printf("| %s | %zu |",
              std::filesystem::path(name).stem().c_str(),
              file.scene.geometry.triangles.size() + file.scene.geometry.spheres.size());
  double best = 1e300;
  for (std::size_t k = 1; k <= embree.size(); ++k)
    best = std::min(best, median(times[k].update) + median(times[k].rays));
  for (std::size_t k = 0; k <= embree.size(); ++k)
    std::printf(" %.1f + %.1f |", median(times[k].update), median(times[k].rays));
  const double own = median(times[0].update) + median(times[0].rays);
  std::printf(embree.empty() ? " - |\n" : " %.2f |\n", own / best);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> scenes;
  int frames = 21;
  if (!set_options(argc, argv, [&](const std::string& word, const char* value) {
        if (word == "--scene")
          scenes.emplace_back(value);
        else if (word == "--frames")
          frames = std::atoi(value);
        return word == "--scene" || word == "--frames";
      })) {
    std::fprintf(stderr, "update [--scene NAME]... [--frames N]\n");
    return 2;
  }
  if (scenes.empty()) {
    scenes = {"balls",
              "mount 6",
              "mount 7",
              "mount 8",
              "meshes 16",
              "meshes 100",
              "meshes 400",
              "ground 1000"};
    const std::string bunny = GRELHA_SHARED_SCENES "/ply/bunny.ply";
    if (std::filesystem::exists(bunny))
      scenes.push_back(bunny);
    else
      std::fprintf(stderr, "skipped: there is no %s\n", bunny.c_str());
  }
  std::printf("| scene | primitives |");
  for (std::size_t k = 0; k < (embree_name().empty() ? 1 : kMethods); ++k)
    std::printf(" %s |", kNames[k]);
  std::printf(" over the best of Embree |\n|---|--:|");
  for (std::size_t k = 0; k < (embree_name().empty() ? 1 : kMethods); ++k)
    std::printf("--:|");
  std::printf("--:|\n");
  for (const std::string& scene : scenes)
    run(scene, frames);
  return 0;
}
