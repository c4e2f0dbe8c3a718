// Judges answers by independent arithmetic, and counts the wrong ones. Exit status 1 if there are
// any.
//
// judge SUBJECT [--count N] [--scene NAME]...
//
//   rules     a million points at and around closed meshes, overlapping, doubled, inside out and
//             thin, and open ones and loose triangles: insides by parity and by winding, and signs
//             of distances, are those of rational numbers; winding numbers are within the error
//             asked for of those of long double, and decide as these do. Takes no --scene
//   distance  1e5 points a closed mesh: the sign is that of contains(), and the distance is that of
//             long double to 1e-6 of the mesh's diagonal
//   queries   a million rays at planes, spheres, triangles and cones: all hits, counts, skip,
//             masks, u and v are those of long double, and the same bits by every instruction set
//   agreement a million rays at nearly edge-on triangles, copies, a lattice and slivers, from 0 to
//             1e13 diagonals on either side, along axes and aslant, with ends of every kind:
//             closest, occluded, all hits, counts, skip and masks, u and v, crossings are those of
//             rational numbers
//
// A scene is a file or `GENERATOR SIZE`; only its triangles are used. Uses all processors.

#include "perf/judge/judge.hpp"

#include <cstdio>
#include <cstdlib>

#include "perf/workloads.hpp"

namespace {

using namespace grelha::perf;

struct Subject {
  const char* name;
  std::size_t count;  ///< unless another is asked for
  std::size_t (*judge)(const JudgeOptions&);
};
constexpr Subject kSubjects[] = {{"rules", 1'000'000, judge_rules},
                                 {"distance", 100'000, judge_distance},
                                 {"queries", 1'000'000, judge_queries},
                                 {"agreement", 1'000'000, judge_agreement}};

}  // namespace

int main(int argc, char** argv) {
  JudgeOptions options;
  const bool known =
      argc > 1 && set_options(argc - 1, argv + 1, [&](std::string word, char* value) {
        if (word == "--count")
          options.count = std::strtoull(value, nullptr, 10);
        else if (word == "--scene")
          options.scenes.emplace_back(value);
        else
          return false;
        return true;
      });
  for (const Subject& s : kSubjects)
    if (known && std::string(argv[1]) == s.name) {
      if (options.count == 0)
        options.count = s.count;
      const std::size_t wrong = s.judge(options);
      std::printf("%zu wrong\n", wrong);
      return wrong == 0 ? 0 : 1;
    }
  std::fprintf(stderr, "judge rules|distance|queries|agreement [--count N] [--scene NAME]...\n");
  return 2;
}
