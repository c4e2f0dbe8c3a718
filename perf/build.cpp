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
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <benchmark/benchmark.h>

#include "frontend/input/read_scene.hpp"
#include "perf/build/clock.hpp"
#include "perf/build/embree_build.hpp"
#include "perf/failed_run.hpp"
#include "tests/support/same_grids.hpp"
#include "perf/workloads.hpp"

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

double least(std::vector<double> v) {
  return *std::min_element(v.begin(), v.end());
}
double median(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  return v[v.size() / 2];
}

SceneFile load(const Row& row, const Options& options) {
  if (row.file.empty())
    return make_scene(row.generator, row.size);
  const std::filesystem::path file = std::filesystem::absolute(options.scenes / row.file);
  return read_scene(file.string(), [](const std::string&) {});
}

/// Builds of a scene by one and by more threads, and what they take.
struct Builds {
  const Scene& scene;
  Result& result;
  std::vector<int> threads;
  /// One device a number of threads, the smaller first.
  std::vector<std::unique_ptr<EmbreeBuilds>> embree{};

  double count() const { return static_cast<double>(result.primitives); }
  /// False: threads change the grid.
  bool check();
  /// Builds in all ways, and gives the sum of their seconds; they are kept where they count.
  double once(bool counts);
};

bool Builds::check() {
  const World one(scene, {.threads = 1});
  for (const int n : {2, 3, 7})
    if (!test::same_grids(one, World(scene, {.threads = n})))
      return false;
  result.bytes["grelha"] = static_cast<double>(one.grid_bytes() + one.geometry_bytes()) / count();
  return true;
}

double Builds::once(bool counts) {
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
      const World world(scene, {.threads = threads[i]});
      note("grelha" + suffix, clock.seconds());
    }
    if (!embree[i])
      continue;
    for (const Quality quality : {Quality::kLow, Quality::kMedium}) {
      const std::string way = quality == Quality::kLow ? "embree low" : "embree medium";
      const Built built = embree[i]->build(quality);
      note(way + suffix, built.seconds);
      result.bytes[way] = built.bytes / count();
    }
  }
  return sum;
}

void tell(benchmark::State& state, const Result& result) {
  state.counters["primitives"] = static_cast<double>(result.primitives);
  for (const auto& [way, seconds] : result.seconds) {
    state.counters[way + " ms"] = 1e3 * median(seconds);
    state.counters[way + " least ms"] = 1e3 * least(seconds);
  }
  for (const auto& [way, bytes] : result.bytes)
    state.counters[way + " bytes"] = bytes;
}

void run(benchmark::State& state, const Row& row, const Options& options) {
  const SceneFile file = load(row, options);
  const Geometry& g = file.scene.geometry;
  Result& result = results[row.name];
  result.primitives = g.spheres.size() + g.triangles.size() + g.cones.size();
  Builds builds{file.scene, result, {1}};
  if (options.threads > 1)
    builds.threads.push_back(options.threads);
  if (!builds.check()) {
    failed = true;
    return state.SkipWithError("threads change the grid");
  }
  // Embree's planes are not those of Grelha; the rows have none.
  for (const int n : builds.threads)
    builds.embree.push_back(make_embree_builds(file.scene, n));
  builds.once(false);  // wakes threads
  for (auto _ : state)
    state.SetIterationTime(builds.once(true));
  tell(state, result);
}

/// The console's own report would be one line of twenty numbers; the table below is read instead.
class Silent : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& r : runs)
      if (is_failed(r))
        std::fprintf(stderr, "%s: %s\n", r.benchmark_name().c_str(), why_failed(r).c_str());
  }
};

void print_head(const Options& options) {
  const int n = options.threads;
  std::printf("\nms: median of %d rounds; ratios of least times\n\n| %-8s | primitives |",
              options.rounds,
              "");
  std::printf(" ms, 1 thread |");
  if (n > 1)
    std::printf(" ms, %d | gain |", n);
  if (has_embree()) {
    std::printf(" / LOW, 1 | / MEDIUM, 1 |");
    if (n > 1)
      std::printf(" / LOW, %d | / MEDIUM, %d | MEDIUM's gain |", n, n);
  }
  std::printf(has_embree() ? " bytes | LOW's | MEDIUM's |\n" : " bytes |\n");
}

void print_row(const Row& row, const Options& options, Result& r) {
  const std::string many = std::string(" ").append(std::to_string(options.threads));
  const bool two = options.threads > 1;
  const auto t = [&](const std::string& way) { return least(r.seconds[way]); };
  std::printf(
      "| %-8s | %zu | %.2f |", row.name.c_str(), r.primitives, 1e3 * median(r.seconds["grelha 1"]));
  if (two)
    std::printf(" %.2f | %.2f |",
                1e3 * median(r.seconds["grelha" + many]),
                t("grelha 1") / t("grelha" + many));
  if (!has_embree()) {
    std::printf(" %.0f |\n", r.bytes["grelha"]);
    return;
  }
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
}

void print_table(const Options& options) {
  print_head(options);
  for (const Row& row : options.rows) {
    const auto found = results.find(row.name);
    if (found != results.end() && !found->second.seconds.empty())
      print_row(row, options, found->second);
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
