// The rungs from brute force to packets; one thread, all in one process: how much each is worth.
//
// ladder [--benchmark_filter=...] [other Google Benchmark options]
//
// Every rung runs at several densities M of the grid; the table at the end takes each at its own
// best. Brute force traces an evenly spread sample of the rays and is reported per ray like the
// others.

#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "perf/failed_run.hpp"
#include "perf/ray_sets.hpp"
#include "perf/workloads.hpp"
#include "tests/reference/reference.hpp"

namespace {

using namespace grelha;
using namespace grelha::perf;

constexpr int kSide = 512;  ///< of the pictures whose shadow rays are made

struct Place {
  std::string name;
  SceneFile file;
  bool shadows;  ///< rays from what the camera sees to a light, in place of camera rays
  RayBuffer rays;
  Answers truth;                                   ///< of the reference walk
  std::map<float, std::unique_ptr<World>> worlds;  ///< by density; 0: no grid

  Place(std::string scene, int size, bool shadows_)
      : name(scene + " " + std::to_string(size) + (shadows_ ? ", shadow rays" : ", camera rays")),
        file(make_scene(scene, size)),
        shadows(shadows_) {
    if (shadows) {
      const RayMaker maker(file, world(2), kSide);
      rays = maker.make(RayKind::kShadow);
    } else {
      rays = camera_rays(file.camera);
    }
    TraceCounts unused;
    trace(world(2), reference_walk(), {}, rays.view(), shadows, truth, unused);
  }
  const World& world(float density) {
    auto& w = worlds[density];
    if (!w)
      w = std::make_unique<World>(file.scene,
                                  BuildOptions{.grid = density > 0, .density = density});
    return *w;
  }
};

struct Rung {
  const char* name;
  const char* isa;
  TraceOptions options;
  bool brute = false;
};

const Rung kRungs[] = {
    {"brute force, scalar", "reference", {.mailbox = false}, true},
    {"grid, scalar", "reference", {.mailbox = false}},
    {"grid, scalar, mailboxes", "reference", {.mailbox = true}},
    {"grid, scalar, leaping over empty cells", "scalar", {.packet = 1}},
    {"single rays, SIMD over primitives", "best", {.packet = 1}},
    {"packets of 16, sse2", "sse2", {.packet = 16}},
    {"packets of 16", "best", {.packet = 16}},
    {"packets of 64, no mailbox", "best", {.packet = 64, .mailbox = false}},
    {"packets of 64, sse2", "sse2", {.packet = 64}},
    {"packets of 64", "best", {.packet = 64}},
    {"packets of 256, sse2", "sse2", {.packet = 256}},
    {"packets of 256", "best", {.packet = 256}},
};
const Variant* variant_of(const Rung& rung) {
  return std::string_view(rung.isa) == "reference" ? &reference_walk() : find_variant(rung.isa);
}
constexpr float kDensities[] = {.5f, .7f, 1, 1.4f, 2, 2.8f, 4, 5.6f};

/// Rays [first, first + count) of a place, by a rung.
void ask(Place& place,
         const Rung& rung,
         const World& world,
         std::size_t first,
         std::size_t count,
         Answers& answers,
         TraceCounts& counts) {
  const Rays rays = place.rays.view(first, count);
  trace(world, *variant_of(rung), rung.options, rays, place.shadows, answers, counts);
}

bool right(const Place& place, const Answers& answers, std::size_t first) {
  for (std::size_t i = 0; i < answers.size(); ++i)
    if (!answers.same(i, place.truth, first + i))
      return false;
  return true;
}

void run(benchmark::State& state, Place& place, const Rung& rung, float density) {
  const World& world = place.world(density);
  // Brute force: a few rows of tiles, spread over the picture.
  const std::size_t total = place.rays.size(), slice = rung.brute ? 256 : total,
                    stride = rung.brute ? total / 8 : total;
  Answers answers;
  TraceCounts counts;
  std::size_t traced = 0;
  for (auto _ : state) {
    for (std::size_t first = 0; first + slice <= total; first += stride) {
      ask(place, rung, world, first, slice, answers, counts);
      traced += slice;
      benchmark::DoNotOptimize(answers.size());
      state.PauseTiming();
      if (!right(place, answers, first))
        state.SkipWithError("wrong hits");
      state.ResumeTiming();
    }
  }
  const double n = static_cast<double>(traced);
  state.counters["ns/ray"] =
      benchmark::Counter(n * 1e-9, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  const TestCounts& t = counts.tests;
  state.counters["tests/ray"] = static_cast<double>(t.sphere + t.triangle + t.cone + t.plane) / n;
  state.counters["cells/ray"] = static_cast<double>(counts.visits) / n;
  state.counters["lanes busy"] =
      static_cast<double>(counts.packets.lanes_busy) /
      static_cast<double>(std::max<std::uint64_t>(counts.packets.lanes_issued, 1));
}

/// The console's own report, then the table of each rung at its best density.
class Table : public benchmark::ConsoleReporter {
 public:
  void ReportRuns(const std::vector<Run>& runs) override {
    ConsoleReporter::ReportRuns(runs);
    for (const Run& r : runs) {
      if (is_failed(r))
        failed = true;
      if (is_failed(r) || r.run_type != Run::RT_Iteration)
        continue;
      const std::string name = r.run_name.function_name;  // scene/rung/M
      const std::size_t a = name.find('/'), b = name.rfind('/');
      Times& t = times_[name.substr(0, a)][name.substr(a + 1, b - a - 1)][name.substr(b + 1)];
      t.push_back(r.counters.at("ns/ray").value);
    }
  }
  void print() {
    for (auto& [scene, of_rungs] : times_) {
      auto& rungs = of_rungs;  // clang++ 14 lets no lambda capture a structured binding
      const auto best = [&](const std::string& rung) {
        std::pair<double, std::string> least{1e300, ""};
        for (auto& [density, t] : rungs[rung]) {
          std::sort(t.begin(), t.end());
          least = std::min(least, {t[t.size() / 2], density});
        }
        return least;
      };
      const double base = rungs.count("grid, scalar") ? best("grid, scalar").first : 0;
      std::printf("\n%s, each rung at its best density\n", scene.c_str());
      std::printf("| %-40s | %10s | %5s | %20s |\n|---|--:|--:|--:|\n",
                  "rung",
                  "ns a ray",
                  "M",
                  "times grid, scalar");
      for (const Rung& r : kRungs)
        if (rungs.count(r.name)) {
          const auto [ns, density] = best(r.name);
          char times[32];
          std::snprintf(times,
                        sizeof times,
                        base < ns / 10 ? "1/%.0f" : "%.2f",
                        base < ns / 10 ? ns / base : base / ns);
          std::printf("| %-40s | %10.1f | %5s | %20s |\n",
                      r.name,
                      ns,
                      r.brute ? "" : density.c_str(),
                      times);
        }
    }
  }
  bool failed = false;

 private:
  using Times = std::vector<double>;
  std::map<std::string, std::map<std::string, std::map<std::string, Times>>> times_;
};

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv))
    return 2;
  std::vector<std::unique_ptr<Place>> places;
  for (const bool shadows : {false, true}) {
    places.push_back(std::make_unique<Place>("balls", 4, shadows));
    places.push_back(std::make_unique<Place>("mount", 7, shadows));
  }
  for (const auto& place : places)
    for (const Rung& rung : kRungs) {
      if (!variant_of(rung) || !variant_of(rung)->is_supported())
        continue;
      for (const float density : kDensities) {
        if (rung.brute && density != kDensities[0])
          continue;
        char m[16];
        std::snprintf(m, sizeof m, "%g", rung.brute ? 0. : static_cast<double>(density));
        benchmark::RegisterBenchmark((place->name + "/" + rung.name + "/" + m).c_str(),
                                     [p = place.get(), &rung, density](benchmark::State& s) {
                                       run(s, *p, rung, rung.brute ? 0 : density);
                                     })
            ->Unit(benchmark::kMillisecond);
      }
    }
  Table table;
  benchmark::RunSpecifiedBenchmarks(&table);
  table.print();
  return table.failed ? 1 : 0;
}
