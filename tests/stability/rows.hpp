#pragma once
// Hard cases for ray tracers, as rows of a table: a name, the condition, the property of each ray,
// and the result of one tracer.
//
// A row makes scenes and rays and says, from exact or long double arithmetic on the very floats a
// tracer gets, what each ray must hit (`Expected`). A ray that no float answer can decide is left
// open: no row asks for more than the rounding that docs/numerics.md states allows. The same rows
// judge Grelha in stability_test.cpp, on a few rays, and Grelha beside Embree in
// perf/stability.cpp, on millions.

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "grelha/geometry.hpp"
#include "tests/support/oracle.hpp"
#include "tests/support/ray_list.hpp"

namespace grelha::stability {

using test::Answers;
using test::Random;
using test::RayList;

/// The required nearest hit of a ray, as far as the ray's own floats determine it: t from
/// `earliest` to `latest`.
struct Expected {
  bool hit = false;    ///< something certainly
  bool miss = false;   ///< nothing certainly; neither: both answers are right
  bool traces = true;  ///< false: a ray that cannot be traced, to which only "nothing" is an answer
  double earliest = 0, latest = test::kInf;
  std::uint32_t left = kNoPrimitive;  ///< the primitive it starts from, not to be hit again
};

/// One scene with its rays.
struct Trial {
  Scene scene;
  RayList rays;
  std::vector<Expected> wanted;
  float density = 0;      ///< of Grelha's grid
  bool occlusion = true;  ///< whether the yes-or-no question is asked too

  void add(const Float3& org, const Float3& dir, const Expected& w, float t_max = test::kInf) {
    rays.add(org, dir, 0, t_max);
    wanted.push_back(w);
  }
};

struct Counts {
  std::uint64_t answers = 0;
  std::uint64_t lost = 0;  ///< went through, or hit what lies behind
  /// hit what is not there, too near, or beside the primitive it names by more than `allowed`
  std::uint64_t false_ = 0;
  std::uint64_t self = 0;  ///< hit what it left
  std::string first;       ///< the first wrong answer, to be pasted into a test
  std::uint64_t wrong() const { return lost + false_ + self; }
  void operator+=(const Counts& o) {
    answers += o.answers;
    lost += o.lost;
    false_ += o.false_;
    self += o.self;
    if (first.empty())
      first = o.first;
  }
};

/// What is asked. `build` before the others; the scene outlives the answers.
class Tracer {
 public:
  virtual ~Tracer() = default;
  virtual void build(const Trial& trial) = 0;
  virtual int ways() const = 0;  ///< of tracing; each is asked
  virtual const char* way_name(int way) const = 0;
  virtual Answers closest(const RayList& rays, int way) = 0;
  virtual Answers occluded(const RayList& rays, int way) = 0;  ///< id: kNoPrimitive or anything
};

using Sink = std::function<void(const Trial&)>;

struct Row {
  const char* name;
  const char* condition;
  const char* truth;  ///< and what is open
  void (*make)(Random& random, std::size_t rays, const Sink& sink);
};

std::vector<Row> mesh_rows();         ///< meshes.cpp: nothing falls between two triangles
std::vector<Row> sphere_rows();       ///< spheres.cpp
std::vector<Row> walk_rows();         ///< walks.cpp: acceleration loses nothing
std::vector<Row> contact_rows();      ///< contacts.cpp: rays that leave surfaces
std::vector<Row> floor_rows();        ///< floors.cpp: triangles far larger than what stands on them
std::vector<Row> point_light_rows();  ///< point_lights.cpp: shadow rays
std::vector<Row> all_rows();

/// Every way of a tracer through one trial.
Counts judge(Tracer& tracer, const Trial& trial);
/// Every way of a tracer through a row.
Counts run(const Row& row, Tracer& tracer, std::size_t rays, std::uint64_t seed);

/// How far beside its primitive docs/numerics.md allows a hit to lie, for a ray that starts
/// `distance` from the primitive in a scene of that diagonal whose coordinates reach `largest`: 46u
/// of the distance, after a far ray was brought near; that move (a rounding of coordinates on three
/// axes); and t, which is one float.
test::oracle::Real allowed(test::oracle::Real distance,
                           test::oracle::Real diagonal,
                           test::oracle::Real largest);

/// Extent of a scene's spheres and triangles.
struct Size {
  double diagonal = 0, largest = 0;
};
Size size_of(const Scene& scene);

/// From every sphere and triangle of the scene in long double: what the ray must hit. `end`: open
/// end of the search.
Expected brute_force(const Scene& scene,
                     const Size& size,
                     const Float3& org,
                     const Float3& dir,
                     float end = test::kInf);

}  // namespace grelha::stability
