#include <cstdio>
#include <vector>

#include "grelha/all_hits.hpp"
#include "grelha/inside.hpp"
#include "perf/judge/judge.hpp"
#include "tests/support/random.hpp"
#include "tests/support/rational.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::perf {
namespace {

/// Directions that disagree with contains().
std::size_t disagreeing(const World& world,
                        const Float3& point,
                        const Float3& vertex,
                        bool inside,
                        test::Random& random) {
  std::size_t wrong = 0;
  for (int k = 0; k < 6; ++k) {
    const Float3 dir = k < 5 ? random.direction() : test::minus(vertex, point);
    wrong += (count_crossings(world, {point, dir}) % 2 == 1) != inside;
  }
  return wrong;
}

}  // namespace

std::size_t judge_inside(const JudgeOptions& options) {
  std::printf("mesh,triangles,points,inside,wrong\n");
  std::size_t all_wrong = 0;
  for (auto& [name, mesh] : closed_meshes(options)) {
    const MovedMesh m = moved(mesh, 0);
    const World world(m.scene, {});
    const test::rational::FirstTriangle exact(m.scene);
    const std::size_t vertices = m.scene.geometry.triangles.vertex_count();
    std::size_t within = 0, wrong = 0;
#pragma omp parallel for reduction(+ : within, wrong) schedule(dynamic, 64)
    for (std::size_t i = 0; i < options.count; ++i) {
      test::Random random(i + 1);
      const Float3 point = test::at(m.middle, .5 * m.diagonal * random.unit(), random.direction());
      const auto v = random.below(static_cast<std::uint32_t>(vertices));
      const bool inside = contains(world, point);
      within += inside;
      // a random ray goes through no edge, so rational numbers count its crossings plainly
      if (i % 10 == 0)
        wrong += (exact.all({point, random.direction()}).size() % 2 == 1) != inside;
      wrong += disagreeing(world, point, test::vertex(m.scene, v), inside, random);
    }
    std::printf("%s,%zu,%zu,%zu,%zu\n",
                name.c_str(),
                m.scene.geometry.triangles.size(),
                options.count,
                within,
                wrong);
    std::fflush(stdout);
    all_wrong += wrong;
  }
  return all_wrong;
}

}  // namespace grelha::perf
