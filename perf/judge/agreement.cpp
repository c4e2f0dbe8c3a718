#include <cstdio>
#include <vector>

#include "perf/judge/judge.hpp"
#include "tests/support/agreement.hpp"

namespace grelha::perf {
namespace {

constexpr std::size_t kTogether = 500;  ///< rays that are asked as one stream

test::WrongAnswers judge_mesh(const Scene& scene, std::uint64_t mesh, std::size_t count) {
  const test::Judge judge(scene);
  test::WrongAnswers sum;
#pragma omp parallel
  {
    test::WrongAnswers own;
#pragma omp for schedule(dynamic)
    for (std::size_t part = 0; part < (count + kTogether - 1) / kTogether; ++part) {
      const std::uint64_t seed = 1'000'000 * mesh + part;
      test::HardRays rays(scene, seed);
      std::vector<Ray> asked(std::min(kTogether, count - part * kTogether));
      for (Ray& ray : asked)
        ray = rays.next();
      own += judge.ask(asked, seed);
    }
#pragma omp critical
    sum += own;
  }
  return sum;
}

void tell(const char* mesh, const test::WrongAnswers& w) {
  std::printf("%s,%zu,%zu,%zu,%zu,%zu,%zu,%zu,%zu,%zu\n",
              mesh,
              w.rays,
              w.hits,
              w.closest,
              w.occluded,
              w.lists,
              w.counts,
              w.filters,
              w.uv,
              w.crossings);
  std::fflush(stdout);
}

}  // namespace

std::size_t judge_agreement(const JudgeOptions& options) {
  std::printf("mesh,rays,hits,closest,occluded,lists,counts,filters,u v,crossings\n");
  const auto meshes = test::agreement_meshes();
  test::WrongAnswers sum;
  std::uint64_t number = 0;
  for (const auto& [name, scene] : meshes) {
    // a thousand copies that a ray hits take as long as a thousand rays
    const bool is_dense = scene.geometry.triangles.a.size() > 4000;
    const std::size_t share = options.count / (meshes.size() - 1);
    const test::WrongAnswers w = judge_mesh(scene, ++number, is_dense ? share / 500 + 1 : share);
    tell(name, w);
    sum += w;
  }
  tell("all", sum);
  return sum.all();
}

}  // namespace grelha::perf
