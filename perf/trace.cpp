// Measures the cost of a ray, by kind and scene, and compares it with Embree on the same rays. One
// thread and one process; the methods take turns.
//
// trace [--scene NAME]... [--kind NAME]... [--size N] [--rounds N] [--scenes DIR] [Google Benchmark
// options]
//
// There is one benchmark for each scene and kind, for example `balls 4/mirror`. Its iterations are
// rounds: in each round every method traces the whole set of rays once. Ratios are computed within
// a round, and their median is reported. A method is timed only if its answers are right: all
// methods of Grelha must agree with each other and, on a sample of rays, with the reference walk in
// every bit; Embree may differ for kDisagree of the rays. A scene is a row of the table, `GENERATOR
// SIZE`, or a file.

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "perf/timing.hpp"
#include "perf/trace/check.hpp"
#include "perf/trace/caller_ways.hpp"
#include "perf/trace/modes.hpp"
#include "perf/trace/options.hpp"
#include "perf/trace/place.hpp"
#include "perf/trace/tables.hpp"

namespace {

using namespace grelha;
using namespace grelha::perf;

constexpr int kTryRounds = 2;      ///< rounds that every method takes part in
constexpr double kAlsoRan = 1.33;  ///< times the best of its side: slower methods are dropped

Results results;
bool failed = false;

/// One scene and kind of rays; answers are overwritten by each way of Grelha's.
struct Race {
  Place& place;
  bool any;
  RayBuffer rays;
  Answers answers;
  TraceCounts unused;
  Cell cell;
};

void trace_grelha(Race& race, const TraceOptions& settings, TraceCounts& counts) {
  const Rays rays = race.rays.view();
  trace(race.place.world, best_variant(), settings, rays, race.any, race.answers, counts);
}

void enter_ways(Race& race) {
  std::vector<Way>& ways = race.cell.ways;
  for (const GrelhaMode& m : kModes)
    ways.push_back({kGrelha, m.name, [&] { trace_grelha(race, m.settings, race.unused); }, {}});
  for (const Side side : {kRobust, kFast})
    for (const EmbreeMode& m : embree_modes()) {
      EmbreeScene* const e = side == kRobust ? race.place.robust.get() : race.place.fast.get();
      ways.push_back({side, m.name, [=, &race] { e->trace(race.rays, race.any, m); }, {}});
    }
}

/// Returns true if a method is reported even if it is slow.
bool is_told(const Cell& cell, std::size_t i) {
  const Way& way = cell.ways[i];
  return i == cell.chosen || i >= cell.first_caller ||
         (way.side == kRobust && !way.name.starts_with("16"));
}

/// Drops methods that are much slower than the best of their side after some rounds.
std::vector<bool> still_in(Cell& cell) {
  cell.find_best();
  std::vector<bool> in(cell.ways.size());
  for (std::size_t i = 0; i < in.size(); ++i) {
    const Way& best = cell.ways[cell.best[cell.ways[i].side]];
    in[i] = is_told(cell, i) || median(cell.ways[i].ns) < kAlsoRan * median(best.ns);
  }
  return in;
}

void run_rounds(benchmark::State& state, Race& race) {
  Cell& cell = race.cell;
  std::vector<bool> in(cell.ways.size(), true);
  int round = 0;
  for (auto _ : state) {
    const double start = cpu_ns();
    if (round++ == kTryRounds)
      in = still_in(cell);
    for (std::size_t i = 0; i < cell.ways.size(); ++i) {
      if (!in[i])
        continue;
      const double from = cpu_ns();
      cell.ways[i].trace();
      cell.ways[i].ns.push_back((cpu_ns() - from) / static_cast<double>(race.rays.size()));
    }
    state.SetIterationTime(1e-9 * (cpu_ns() - start));
  }
  cell.find_best();
  trace_grelha(race, kModes[cell.chosen].settings, cell.counts);
}

void count(benchmark::State& state, const Cell& cell) {
  constexpr const char* kSideNames[] = {"grelha ", "embree robust ", "embree fast "};
  for (const Way& w : cell.ways)
    state.counters[kSideNames[w.side] + w.name + " ns"] = median(w.ns);
  state.counters["rays"] = static_cast<double>(cell.rays);
  state.counters["hits"] = cell.hit_share;
  state.counters["disagree"] = cell.disagree;
  state.counters["ns/ray"] = median(cell.ways[cell.chosen].ns);
  state.counters["tests/ray"] = cell.tests();
  state.counters["cells/ray"] = cell.cells();
  state.counters["lanes busy"] = cell.lanes_busy();
  state.counters["fell back"] = cell.packet_fallbacks();
  if (!cell.has_embree())
    return;
  state.counters["ratio"] = cell.ratio(cell.chosen, cell.best[kRobust]);
  state.counters["ratio of the best"] = cell.ratio(cell.best[kGrelha], cell.best[kRobust]);
  state.counters["ratio to fast"] = cell.ratio(cell.chosen, cell.best[kFast]);
  const std::vector<double> caller = cell.caller_ratios();
  state.counters["ratio of calls"] = caller[0];
  state.counters["ratio of streams of 8"] = caller[1];
  state.counters["ratio by default"] = caller[2];
}

void print_line(const Row& row, std::size_t kind, const Cell& cell) {
  const Way& chosen = cell.ways[cell.chosen];
  const Way& best = cell.ways[cell.best[kGrelha]];
  std::printf("%-8s %-11s %6.1f ns %5.1f Mrays/s %s",
              row.name.c_str(),
              kRayKinds[kind],
              median(chosen.ns),
              1e3 / median(chosen.ns),
              chosen.name.c_str());
  if (&best != &chosen)
    std::printf(" (%s: %.1f ns)", best.name.c_str(), median(best.ns));
  if (cell.has_embree()) {
    const Way& robust = cell.ways[cell.best[kRobust]];
    const Way& fast = cell.ways[cell.best[kFast]];
    std::printf(
        "; Embree robust %.1f ns %s, fast %.1f ns %s; ratio %.2f; %.2g %% meet something else",
        median(robust.ns),
        robust.name.c_str(),
        median(fast.ns),
        fast.name.c_str(),
        cell.ratio(cell.chosen, cell.best[kRobust]),
        100 * cell.disagree);
  }
  std::printf("\n");
  std::fflush(stdout);
}

void run(benchmark::State& state, const Row& row, std::size_t kind, const Options& options) {
  const auto fail = [&](const std::string& why) {
    std::printf("%s, %s: %s\n", row.name.c_str(), kRayKinds[kind], why.c_str());
    failed = true;
    state.SkipWithError(why.c_str());
  };
  const auto rays_kind = static_cast<RayKind>(kind);
  Place& p = place(row, options);
  Race race{p, RayMaker::any_hit(rays_kind), p.maker.make(rays_kind), {}, {}, {}};
  if (race.rays.size() == 0)
    return fail("no such rays");
  race.cell.rays = race.rays.size();
  if (const std::string wrong = check(p, race.rays, race.any, race.cell); !wrong.empty())
    return fail(wrong);
  enter_ways(race);
  CallerWays caller_ways(p.world, race.any);
  caller_ways.enter(race.rays, race.cell);
  run_rounds(state, race);
  count(state, race.cell);
  print_line(row, kind, race.cell);
  results[row.name][kind] = race.cell;
}

/// run() prints what there is to say.
class Silent : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>&) override {}
};

int usage() {
  std::fprintf(
      stderr,
      "usage: trace [--scene NAME]... [--kind NAME]... [--size N] [--rounds N] [--scenes DIR] "
      "[Google Benchmark options]\n"
      "  scenes: a row of the table, GENERATOR SIZE, or a file; size: 32 to 16384; kinds:");
  for (const char* k : kRayKinds)
    std::fprintf(stderr, " '%s'", k);
  std::fprintf(stderr, "\n");
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  Options options;
  if (!parse(argc, argv, options))
    return usage();
  if (const std::string beside = embree_name(); !beside.empty()) {
    std::printf("beside %s\n", beside.c_str());
    benchmark::AddCustomContext("embree", beside);
  }
  for (const Row& row : options.rows)
    for (const std::size_t kind : options.kinds)
      benchmark::RegisterBenchmark((row.name + "/" + kRayKinds[kind]).c_str(),
                                   [&, kind](benchmark::State& s) { run(s, row, kind, options); })
          ->Iterations(options.rounds)
          ->UseManualTime()
          ->Unit(benchmark::kMillisecond);
  try {
    Silent silent;
    benchmark::RunSpecifiedBenchmarks(&silent);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "trace: %s\n", e.what());
    return 1;
  }
  if (!results.empty())
    print_tables(options, results);
  return failed ? 1 : 0;
}
