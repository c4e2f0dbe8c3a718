// Measures the cost of a call for one ray, and compares it with streams of the same rays and with
// Embree's rtcIntersect1 and rtcOccluded1. One thread and one process; the methods take turns.
//
// calls [--size N] [--rounds N] [--scene NAME]...
//
// A scene is a file, or `GENERATOR SIZE`; without any, 2000 spheres and a mountain. The rays are
// camera rays, one for each pixel of N x N, in the order of the picture and in random order. A
// method is timed only if its answers agree with those of the stream: in every bit for Grelha, for
// all but kDisagree of the rays for Embree. Empty: the same rays with nothing between t_min and
// t_max.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "grelha/query.hpp"
#include "perf/embree.hpp"
#include "perf/timing.hpp"
#include "perf/workloads.hpp"

namespace {

using namespace grelha;
using namespace grelha::perf;

constexpr double kDisagree = .005;

struct Options {
  int size = 256, rounds = 15;
  std::vector<std::string> scenes;
};

struct Way {
  std::string name;
  std::function<void()> trace;
  std::vector<double> ns{};  ///< a ray, by round
};

Scene spheres(int count) {
  std::mt19937 random(17);
  const auto unit = [&] { return float(random() >> 8) * 0x1p-24f; };
  Scene scene;
  scene.materials.push_back({});
  for (int i = 0; i < count; ++i) {
    const float x = unit(), y = unit(), z = unit();
    scene.geometry.spheres.add({x, y, z}, .01f + .03f * unit(), 0);
  }
  return scene;
}

RayBuffer shuffled(const RayBuffer& from) {
  std::vector<std::size_t> order(from.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    order[i] = i;
  std::mt19937 random(1);
  for (std::size_t i = order.size(); i > 1; --i)
    std::swap(order[i - 1], order[random() % i]);
  RayBuffer to;
  for (const std::size_t i : order)
    to.add(
        {from.ox[i], from.oy[i], from.oz[i]}, {from.dx[i], from.dy[i], from.dz[i]}, from.t_max[i]);
  return to;
}

RayBuffer emptied(RayBuffer rays) {
  rays.t_min.assign(rays.size(), 1);
  rays.t_max.assign(rays.size(), 1);
  return rays;
}

/// Rays whose answers differ.
std::size_t different(const Answers& a, const Answers& b) {
  std::size_t n = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    n += !a.same(i, b, i);
  return n;
}

/// Rays that hit something in one and nothing in the other.
std::size_t other_hits(const Answers& a, const Answers& b) {
  std::size_t n = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    n += a.met(i) != b.met(i);
  return n;
}

/// False: some answer is wrong.
bool row(const std::string& name,
         const World& world,
         EmbreeScene* embree,
         const RayBuffer& rays,
         bool any,
         const Options& options) {
  const RayBuffer empty = emptied(rays);
  Answers truth, found;
  ask_in_streams(world, rays, any, rays.size(), {.packet = 64}, truth);
  call_each(world, rays, any, found);
  if (different(truth, found) != 0) {
    std::printf("%s: calls and streams differ\n", name.c_str());
    return false;
  }
  std::vector<Way> ways{
      {"call", [&] { call_each(world, rays, any, found); }},
      {"empty", [&] { call_each(world, empty, any, found); }},
      {"stream of 1", [&] { ask_in_streams(world, rays, any, rays.size(), {.packet = 1}, found); }},
      {"stream of 64",
       [&] { ask_in_streams(world, rays, any, rays.size(), {.packet = 64}, found); }}};
  if (embree) {
    const EmbreeMode single = embree_modes()[0];
    embree->trace(rays, any, single);
    if (double(other_hits(truth, embree->answers())) > kDisagree * double(rays.size())) {
      std::printf("%s: Embree meets something else\n", name.c_str());
      return false;
    }
    ways.push_back({"Embree's call", [&, single] { embree->trace(rays, any, single); }});
    ways.push_back({"its empty", [&, single] { embree->trace(empty, any, single); }});
  }
  for (int round = 0; round < options.rounds; ++round)
    for (Way& way : ways) {
      const double from = cpu_ns();
      way.trace();
      way.ns.push_back((cpu_ns() - from) / static_cast<double>(rays.size()));
    }
  std::printf("| %-28s |", name.c_str());
  for (const Way& way : ways)
    std::printf(" %.0f |", median(way.ns));
  std::printf("\n");
  return true;
}

bool table(const std::string& name, const Scene& scene, const Camera& camera, const Options& o) {
  const World world(scene, {});
  const auto embree = make_embree_scene(scene, true);
  const RayBuffer rays = camera_rays(camera), mixed = shuffled(rays);
  bool right = true;
  for (const bool any : {false, true})
    for (const bool ordered : {true, false})
      right &= row(name + (any ? ", any" : ", closest") + (ordered ? "" : ", shuffled"),
                   world,
                   embree.get(),
                   ordered ? rays : mixed,
                   any,
                   o);
  return right;
}

bool table_of_file(const std::string& name, const Options& o) {
  const SceneFile file = scene_named(name);
  Camera camera = file.camera;
  camera.width = camera.height = o.size;
  const auto slash = name.rfind('/');
  return table(slash == std::string::npos ? name : name.substr(slash + 1), file.scene, camera, o);
}

bool table_of_spheres(const Options& o) {
  Camera camera;
  camera.eye = {.5f, .5f, 3};
  camera.at = {.5f, .5f, .5f};
  camera.angle_deg = 30;
  camera.width = camera.height = o.size;
  return table("2000 spheres", spheres(2000), camera, o);
}

bool set_option(const std::string& word, const std::string& value, Options& o) {
  const int number = std::atoi(value.c_str());
  if (word == "--scene")
    o.scenes.push_back(value);
  else if (word == "--size" && number >= 1 && number <= 4096)
    o.size = number;
  else if (word == "--rounds" && number >= 1 && number <= 4096)
    o.rounds = number;
  else
    return false;
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  const auto set = [&](const char* word, const char* value) {
    return set_option(word, value, options);
  };
  if (!set_options(argc, argv, set)) {
    std::fprintf(stderr, "usage: calls [--size N] [--rounds N] [--scene NAME]...\n");
    return 2;
  }
  const std::string embree = embree_name();
  const bool beside = !embree.empty();
  if (beside)
    std::printf("beside %s\n", embree.c_str());
  std::printf(
      "ns a ray, median of %d rounds\n\n| | call | empty | stream of 1 | stream of 64 |%s\n"
      "|---|--:|--:|--:|--:|%s\n",
      options.rounds,
      beside ? " rtcIntersect1 | empty |" : "",
      beside ? "--:|--:|" : "");
  bool right = true;
  if (options.scenes.empty()) {
    right &= table_of_spheres(options);
    options.scenes = {"mount 6"};
  }
  for (const std::string& scene : options.scenes)
    right &= table_of_file(scene, options);
  return right ? 0 : 1;
}
