// Grid construction beside Embree's trees: seconds and bytes, one thread and more, all taking turns
// in one process.
//
// build [--scene NAME]... [--rounds N] [--threads N] [--scenes DIR] [Google Benchmark options]
//
// Grelha: the constructor of World, from the caller's arrays to what rays need. Embree:
// rtcCommitScene of a new scene over buffers that are already filled. Neither includes reading a
// file. Before anything is timed, grids made by one thread and by several are compared, byte for
// byte.

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <benchmark/benchmark.h>

#include "kernel/grid/world_impl.hpp"
#include "perf/workloads.hpp"

#ifdef GRELHA_EMBREE
#include <embree3/rtcore.h>
#endif

namespace {

using namespace grelha;
using namespace grelha::perf;

struct Row {
  std::string name;
  std::string file;  ///< in the folder of scenes; the row is left out where it is absent
  std::string generator;
  int size = 0;
};

const std::vector<Row> kRows = {{"balls 4", "", "balls", 4},
                                {"balls 5", "", "balls", 5},
                                {"balls 6", "", "balls", 6},
                                {"mount 6", "", "mount", 6},
                                {"mount 7", "", "mount", 7},
                                {"mount 8", "", "mount", 8},
                                {"mount 9", "", "mount", 9},
                                {"bunny", "ply/bunny.ply", "", 0},
                                {"dragon", "ply/dragon.ply", "", 0}};

struct Options {
  std::vector<Row> rows;
  int rounds = 9;
  int threads = std::max(1, std::min(2, static_cast<int>(std::thread::hardware_concurrency())));
  std::filesystem::path scenes = GRELHA_SHARED_SCENES;
};

/// What one row came to: seconds by way, least and median; bytes a primitive.
struct Result {
  std::size_t primitives = 0;
  std::map<std::string, std::vector<double>> seconds;
  std::map<std::string, double> bytes;
};
std::map<std::string, Result> results;
bool failed = false;

double least(std::vector<double> v) { return *std::min_element(v.begin(), v.end()); }
double median(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  return v[v.size() / 2];
}

class Clock {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

SceneFile load(const Row& row, const Options& options) {
  if (row.file.empty())
    return make_scene(row.generator, row.size);
  const std::filesystem::path file = std::filesystem::absolute(options.scenes / row.file);
  return read_scene(file.string(), [](const std::string&) {});
}

template <class T>
bool same(const T& a, const T& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0);
}

bool same(const CellStore& a, const CellStore& b) {
  bool all = true;
  const auto compare = [&](const auto& one, const auto& other) { all = all && same(one, other); };
  for_each_finite_shape([&]<class Shape>() {
    const auto& one = a.of<Shape>();
    const auto& other = b.of<Shape>();
    compare(one.first, other.first);
    if constexpr (ListStore<Shape>::kInBlocks) {
      compare(one.blocks, other.blocks);
      compare(one.boxes, other.boxes);
    } else {
      compare(one.id, other.id);
      Shape::for_each_field(compare, one.fields, other.fields);
    }
  });
  return all;
}

bool same(const World& a, const World& b) {
  const World::Impl &x = a.impl(), &y = b.impl();
  bool all = same(x.outside, y.outside) && x.grids.size() == y.grids.size();
  for (std::size_t i = 0; all && i < x.grids.size(); ++i)
    all = x.grids[i].cells == y.grids[i].cells && same(x.grids[i].store, y.grids[i].store) &&
          same(x.grids[i].distance, y.grids[i].distance);
  return all;
}

#ifdef GRELHA_EMBREE
/// Embree with so many threads. Its arrays are made once; each build is of a new scene over them.
class Embree {
 public:
  Embree(const Scene& scene, int threads)
      : device_(rtcNewDevice(("threads=" + std::to_string(threads)).c_str())) {
    rtcSetDeviceMemoryMonitorFunction(
        device_,
        [](void* sum, ssize_t bytes, bool) {
          __atomic_add_fetch(static_cast<std::int64_t*>(sum), bytes, __ATOMIC_RELAXED);
          return true;
        },
        &bytes_);
    const Geometry& g = scene.geometry;
    for (std::size_t i = 0; i < g.spheres.size(); ++i)
      spheres_.insert(
          spheres_.end(),
          {g.spheres.x[i], g.spheres.y[i], g.spheres.z[i], std::abs(g.spheres.radius[i])});
    const Triangles& t = g.triangles;
    for (std::size_t i = 0; i < t.vertex_count(); ++i)
      vertices_.insert(vertices_.end(), {t.x[i], t.y[i], t.z[i]});
    vertices_.push_back(0);  // it reads four floats at a time
    for (std::size_t i = 0; i < t.size(); ++i)
      corners_.insert(corners_.end(), {t.a[i], t.b[i], t.c[i]});
    geometry_bytes_ = spheres_.size() * sizeof(float) + vertices_.size() * sizeof(float) +
                      corners_.size() * sizeof(corners_[0]);
  }
  ~Embree() { rtcReleaseDevice(device_); }
  Embree(const Embree&) = delete;
  Embree& operator=(const Embree&) = delete;

  /// Seconds of a build; `bytes` becomes what the scene keeps, its arrays among it.
  double build(RTCBuildQuality quality, double& bytes) {
    const std::int64_t before = __atomic_load_n(&bytes_, __ATOMIC_RELAXED);
    const RTCScene scene = rtcNewScene(device_);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene, quality);
    if (!spheres_.empty()) {
      const RTCGeometry g = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_SPHERE_POINT);
      rtcSetSharedGeometryBuffer(g,
                                 RTC_BUFFER_TYPE_VERTEX,
                                 0,
                                 RTC_FORMAT_FLOAT4,
                                 spheres_.data(),
                                 0,
                                 16,
                                 spheres_.size() / 4);
      attach(scene, g, quality);
    }
    if (!corners_.empty()) {
      const RTCGeometry g = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
      rtcSetSharedGeometryBuffer(g,
                                 RTC_BUFFER_TYPE_VERTEX,
                                 0,
                                 RTC_FORMAT_FLOAT3,
                                 vertices_.data(),
                                 0,
                                 12,
                                 vertices_.size() / 3);
      rtcSetSharedGeometryBuffer(g,
                                 RTC_BUFFER_TYPE_INDEX,
                                 0,
                                 RTC_FORMAT_UINT3,
                                 corners_.data(),
                                 0,
                                 12,
                                 corners_.size() / 3);
      attach(scene, g, quality);
    }
    const Clock clock;
    rtcCommitScene(scene);
    const double seconds = clock.seconds();
    if (rtcGetDeviceError(device_) != RTC_ERROR_NONE)
      throw std::runtime_error("Embree refuses the scene");
    bytes = static_cast<double>(__atomic_load_n(&bytes_, __ATOMIC_RELAXED) - before) +
            static_cast<double>(geometry_bytes_);
    rtcReleaseScene(scene);
    return seconds;
  }

 private:
  static void attach(RTCScene scene, RTCGeometry g, RTCBuildQuality quality) {
    rtcSetGeometryBuildQuality(g, quality);
    rtcCommitGeometry(g);
    rtcAttachGeometry(scene, g);
    rtcReleaseGeometry(g);
  }
  RTCDevice device_;
  std::int64_t bytes_ = 0;
  std::size_t geometry_bytes_ = 0;
  std::vector<float> spheres_, vertices_;
  std::vector<std::uint32_t> corners_;
};
#endif

void run(benchmark::State& state, const Row& row, const Options& options) {
  const SceneFile file = load(row, options);
  const Geometry& g = file.scene.geometry;
  Result& result = results[row.name];
  result.primitives = g.spheres.size() + g.triangles.size() + g.cones.size();
  const double count = static_cast<double>(result.primitives);
  std::vector<int> threads{1};
  if (options.threads > 1)
    threads.push_back(options.threads);
  {
    const World one(file.scene, {.threads = 1});
    for (const int n : {2, 3, 7})
      if (!same(one, World(file.scene, {.threads = n}))) {
        failed = true;
        return state.SkipWithError("threads change the grid");
      }
    result.bytes["grelha"] = static_cast<double>(one.grid_bytes() + one.geometry_bytes()) / count;
  }
#ifdef GRELHA_EMBREE
  // Embree's planes are not those of Grelha; the rows have none. One device a number of threads,
  // the smaller first.
  std::vector<std::unique_ptr<Embree>> embrees;
  for (const int n : threads)
    embrees.push_back(std::make_unique<Embree>(file.scene, n));
#endif
  // A first round, not counted, wakes threads.
  bool counts = false;
  const auto once = [&] {
    double sum = 0;
    const auto note = [&](const std::string& way, double seconds) {
      if (counts)
        result.seconds[way].push_back(seconds);
      sum += seconds;
    };
    for (std::size_t i = 0; i < threads.size(); ++i) {
      const std::string suffix = std::string(" ").append(std::to_string(threads[i]));
      {
        const Clock clock;
        const World world(file.scene, {.threads = threads[i]});
        note("grelha" + suffix, clock.seconds());
      }
#ifdef GRELHA_EMBREE
      double bytes = 0;
      note("embree low" + suffix, embrees[i]->build(RTC_BUILD_QUALITY_LOW, bytes));
      result.bytes["embree low"] = bytes / count;
      note("embree medium" + suffix, embrees[i]->build(RTC_BUILD_QUALITY_MEDIUM, bytes));
      result.bytes["embree medium"] = bytes / count;
#endif
    }
    return sum;
  };
  once();
  counts = true;
  for (auto _ : state)
    state.SetIterationTime(once());

  state.counters["primitives"] = count;
  for (const auto& [way, seconds] : result.seconds) {
    state.counters[way + " ms"] = 1e3 * median(seconds);
    state.counters[way + " least ms"] = 1e3 * least(seconds);
  }
  for (const auto& [way, bytes] : result.bytes)
    state.counters[way + " bytes"] = bytes;
}

/// The console's own report would be one line of twenty numbers; the table below is read instead.
class Silent : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& r : runs)
      if (r.error_occurred)
        std::fprintf(stderr, "%s: %s\n", r.benchmark_name().c_str(), r.error_message.c_str());
  }
};

void print_table(const Options& options) {
  const std::string many = " " + std::to_string(options.threads);
  std::printf("\nms: median of %d rounds; ratios of least times\n\n| %-8s | primitives |",
              options.rounds,
              "");
  const bool two = options.threads > 1;
  std::printf(" ms, 1 thread |");
  if (two)
    std::printf(" ms,%s | gain |", many.c_str());
#ifdef GRELHA_EMBREE
  std::printf(" / LOW, 1 | / MEDIUM, 1 |");
  if (two)
    std::printf(" / LOW,%s | / MEDIUM,%s | MEDIUM's gain |", many.c_str(), many.c_str());
  std::printf(" bytes | LOW's | MEDIUM's |\n");
#else
  std::printf(" bytes |\n");
#endif
  for (const Row& row : options.rows) {
    const auto found = results.find(row.name);
    if (found == results.end() || found->second.seconds.empty())
      continue;
    Result& r = found->second;
    const auto t = [&](const std::string& way) { return least(r.seconds[way]); };
    std::printf("| %-8s | %zu | %.2f |",
                row.name.c_str(),
                r.primitives,
                1e3 * median(r.seconds["grelha 1"]));
    if (two)
      std::printf(" %.2f | %.2f |",
                  1e3 * median(r.seconds["grelha" + many]),
                  t("grelha 1") / t("grelha" + many));
#ifdef GRELHA_EMBREE
    std::printf(
        " %.2f | %.2f |", t("grelha 1") / t("embree low 1"), t("grelha 1") / t("embree medium 1"));
    if (two)
      std::printf(" %.2f | %.2f | %.2f |",
                  t("grelha" + many) / t("embree low" + many),
                  t("grelha" + many) / t("embree medium" + many),
                  t("embree medium 1") / t("embree medium" + many));
    std::printf(" %.0f | %.0f | %.0f |\n",
                r.bytes["grelha"],
                r.bytes["embree low"],
                r.bytes["embree medium"]);
#else
    std::printf(" %.0f |\n", r.bytes["grelha"]);
#endif
  }
}

Row row_named(const std::string& name) {
  for (const Row& row : kRows)
    if (row.name == name)
      return row;
  if (const auto space = name.find(' '); space != std::string::npos)
    return {name, "", name.substr(0, space), std::atoi(name.c_str() + space)};
  return {name, name, "", 0};
}

/// False: a word is not understood.
bool parse(int argc, char** argv, Options& o) {
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (++i == argc)
      return false;
    const std::string value = argv[i];
    if (word == "--scene")
      o.rows.push_back(row_named(value));
    else if (word == "--rounds")
      o.rounds = std::atoi(value.c_str());
    else if (word == "--threads")
      o.threads = std::atoi(value.c_str());
    else if (word == "--scenes")
      o.scenes = value;
    else
      return false;
  }
  const bool all = o.rows.empty();
  if (all)
    o.rows = kRows;
  std::erase_if(o.rows, [&](const Row& r) {
    return all && !r.file.empty() && !std::filesystem::exists(o.scenes / r.file);
  });
  return o.rounds >= 1 && o.threads >= 1 && o.threads <= 1024;
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  Options options;
  if (!parse(argc, argv, options)) {
    std::fprintf(stderr,
                 "usage: build [--scene NAME]... [--rounds N] [--threads N] [--scenes DIR] [Google "
                 "Benchmark options]\n"
                 "  scenes: a row of the table, GENERATOR SIZE, or a file; threads: the larger of "
                 "the two numbers compared, 1 to 1024\n");
    return 2;
  }
  for (const Row& row : options.rows)
    benchmark::RegisterBenchmark(row.name.c_str(),
                                 [&](benchmark::State& s) { run(s, row, options); })
        ->Iterations(options.rounds)
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
  try {
    Silent silent;
    benchmark::RunSpecifiedBenchmarks(&silent);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "build: %s\n", e.what());
    return 1;
  }
  if (!results.empty())
    print_table(options);
  return failed ? 1 : 0;
}
