// What a ray-triangle test costs and how far off it is: by instruction set, in single and double
// precision, watertight (Woop, Benthin, Wald 2013) or after Möller and Trumbore (1997), with and
// without fused multiply-add.
//
// precision [--scenes] [--groups N] [Google Benchmark options; --benchmark_format=json]
//
// Each test is one benchmark, isa/precision/method. Its counters say how it erred, judged in 113
// bits, where the six products of three differences of floats are exact for the sizes used here:
//
// max_ulp, p999_ulp  |t - true t| in units in the last place of the true t as a float, of rays
//                    through random triangles
// wrong              of these, rays whose nearest triangle is another than the true one
// leaks              of rays from within a closed hull aimed at its corners and edges, those that
//                    meet nothing
// ns                 a test of a ray and a triangle, of triangles at most four times as long as
//                    wide
//
// With --scenes whole traces instead, isa/precision/scene: camera rays of generated scenes through
// their grids. Errors are those of t before it is rounded, judged in long double against every
// primitive of the scene; leaks: rays that meet nothing where there is something; ns: a ray. Beside
// them embree/default/scene and embree/robust/scene, 16 coherent rays side by side, where Embree
// is.

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "perf/precision/counters.hpp"
#include "perf/precision/scenes.hpp"
#include "perf/precision/workload.hpp"
#include "perf/precision_loops.hpp"

namespace {

using namespace grelha::perf;

PairHits room_for(const Pairs& p) {
  const std::size_t n = static_cast<std::size_t>(p.groups()) * kGroup;
  return {std::vector<double>(n), std::vector<int>(n)};
}

void run(benchmark::State& state, const Workload& work, void (*loop)(const Pairs&, PairHits&)) {
  PairHits hits = room_for(work.random), hulls = room_for(work.hulls);
  loop(work.hulls, hulls);
  loop(work.random, hits);
  Errors errors;
  errors.rays = static_cast<double>(hits.t.size());
  for (std::size_t i = 0; i < hits.t.size(); ++i) {
    if (hits.triangle[i] != work.truth.triangle[i])
      ++errors.wrong;
    else if (hits.triangle[i] >= 0)
      errors.ulps.push_back(ulps(hits.t[i], work.truth.t[i]));
  }
  for (const int t : hulls.triangle)
    errors.leaks += t < 0;
  for (auto _ : state) {
    loop(work.timed, hits);
    benchmark::DoNotOptimize(hits.t.data());
  }
  set_time(state, static_cast<double>(hits.t.size()) * kGroup);
  set_counters(state, std::move(errors));
}

std::vector<const PrecisionLoops*> all_loops() {
  return {
      &k_scalar_precision,
#ifdef GRELHA_X86_VARIANTS
      &k_sse2_precision,
      &k_avx2_precision,
      &k_avx512_precision,
      &k_avx2_fused_precision,
      &k_avx512_fused_precision,
#endif
  };
}

void register_loops(const PrecisionLoops& isa, const Workload& work) {
  for (int in_double = 0; in_double < 2; ++in_double)
    for (int watertight = 0; watertight < 2; ++watertight)
      benchmark::RegisterBenchmark(
          (std::string(isa.isa) + (isa.fused ? "+fma" : "") +
           (in_double ? "/double/" : "/single/") + (watertight ? "watertight" : "moeller-trumbore"))
              .c_str(),
          [&work, loop = isa.loop[in_double][watertight]](benchmark::State& s) {
            run(s, work, loop);
          });
}

int run_tests(int groups) {
  const Workload work(groups);
  for (const PrecisionLoops* isa : all_loops()) {
    if (isa->runs_here())
      register_loops(*isa, work);
    else
      std::fprintf(
          stderr, "precision: this processor has no %s: left out\n", std::string(isa->isa).c_str());
  }
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  int groups = 4096, at = 1;
  const bool scenes = at < argc && std::string(argv[at]) == "--scenes";
  at += scenes;
  if (at + 1 < argc && std::string(argv[at]) == "--groups") {
    groups = std::atoi(argv[at + 1]);
    at += 2;
  }
  if (groups < 1 || at != argc) {
    std::fprintf(stderr, "usage: precision [--scenes] [--groups N] [Google Benchmark options]\n");
    return 2;
  }
  return scenes ? run_scenes(groups) : run_tests(groups);
}
