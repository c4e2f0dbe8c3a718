#pragma once
// Every way the kernel has of tracing a bundle of rays, and the comparison of two answers bit for
// bit.

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "grelha/render.hpp"
#include "tests/reference/reference.hpp"
#include "tests/support/ray_list.hpp"

namespace grelha {
inline void PrintTo(const Variant* v, std::ostream* out) {
  *out << v->name;
}
}  // namespace grelha

namespace grelha::test {

/// Long enough for many packets of each size; 1021 is prime, so every width and packet size has a
/// tail.
inline constexpr int kManyRays = 1021;

struct Way {
  const char* name;
  TraceOptions settings;
};

inline const std::vector<Way>& every_way() {
  static const std::vector<Way> ways{{"packets of 256", {256, true}},
                                     {"packets of 256 without mailboxes", {256, false}},
                                     {"packets of 64", {64, true}},
                                     {"packets of 64 without mailboxes", {64, false}},
                                     {"packets of 16", {16, true}},
                                     {"packets of 16 without mailboxes", {16, false}},
                                     {"single", {1, true}}};
  return ways;
}

/// Those of the plain walk.
inline const std::vector<Way>& every_reference_way() {
  static const std::vector<Way> ways{
      {"reference", {.mailbox = true}},
      {"reference without mailboxes", {.mailbox = false}},
  };
  return ways;
}

/// Brute force by the plainest path there is: scalar, one ray, one primitive at a time, no grid.
struct Truth {
  Answers closest, occluded;
};

inline Truth truth_of(const Scene& scene,
                      const RayList& rays,
                      const Variant& reference = reference_walk()) {
  const World plain(scene, {.grid = false});
  return {trace(reference, plain, rays, {.mailbox = false}, Query::kClosest),
          trace(reference, plain, rays, {.mailbox = false}, Query::kOccluded)};
}

inline std::string show(float t, std::uint32_t id) {
  std::ostringstream s;
  s << "t " << t << " (" << std::hexfloat << t << std::dec << ") id "
    << static_cast<std::int64_t>(id == kNoPrimitive ? -1 : std::int64_t{id});
  return s.str();
}

/// Numbers whose squares are finite, and a direction: anything else hits nothing, whatever it
/// points at.
inline bool sound(const RayList& rays, std::size_t i) {
  const Float3 o = rays.org(i), d = rays.dir(i);
  if (std::max({std::abs(o.x), std::abs(o.y), std::abs(o.z)}) > 1e18f)
    return false;
  const float dd = (d.x * d.x + d.y * d.y) + d.z * d.z;
  return std::isfinite(o.x + o.y + o.z) && std::isfinite(dd) && std::isfinite(1 / dd);
}

/// Compares answers: for closest hits the primitive and the bits of t; for occlusion the yes or no,
/// in the same encoding. The t of rays that cannot be traced at all is tested in variants_test.
inline testing::AssertionResult same(const Answers& wanted,
                                     const Answers& got,
                                     const RayList& rays,
                                     Query query) {
  std::size_t wrong = 0, first = 0;
  for (std::size_t i = rays.size(); i-- > 0;) {
    const bool ids = query == Query::kClosest
                         ? wanted.id[i] == got.id[i]
                         : (wanted.id[i] == kNoPrimitive) == (got.id[i] == kNoPrimitive);
    if (ids && wanted.id[i] == kNoPrimitive && !sound(rays, i))
      continue;
    if (ids && std::bit_cast<std::uint32_t>(wanted.t[i]) == std::bit_cast<std::uint32_t>(got.t[i]))
      continue;
    ++wrong;
    first = i;
  }
  if (wrong == 0)
    return testing::AssertionSuccess();
  return testing::AssertionFailure()
         << wrong << " of " << rays.size() << " differ; " << rays.describe(first) << "\n  expected "
         << show(wanted.t[first], wanted.id[first]) << "\n  got      "
         << show(got.t[first], got.id[first]);
}

/// One way of one variant through one world against the truth.
inline bool finds_truth(const Variant& variant,
                        const Way& way,
                        const World& world,
                        const RayList& rays,
                        const Truth& truth,
                        const std::string& what) {
  for (const Query query : {Query::kClosest, Query::kOccluded}) {
    const bool closest = query == Query::kClosest;
    const auto result = same(closest ? truth.closest : truth.occluded,
                             trace(variant, world, rays, way.settings, query),
                             rays,
                             query);
    if (result)
      continue;
    ADD_FAILURE() << what << (closest ? ", closest, " : ", occluded, ") << way.name << ", "
                  << variant.name << ": " << result.message();
    return false;
  }
  return true;
}

/// Every way of one variant, and beside the scalar one the reference's own; stops at the first that
/// differs.
inline void expect_truth(const Variant& variant,
                         const World& world,
                         const RayList& rays,
                         const Truth& truth,
                         const std::string& what,
                         const Variant& reference = reference_walk()) {
  for (const Way& way : every_way())
    if (!finds_truth(variant, way, world, rays, truth, what))
      return;
  if (variant.lanes > 1)
    return;
  for (const Way& way : every_reference_way())
    if (!finds_truth(reference, way, world, rays, truth, what))
      return;
}

inline std::size_t hits_of(const Answers& a) {
  std::size_t n = 0;
  for (const std::uint32_t id : a.id)
    n += id != kNoPrimitive;
  return n;
}

/// A test for each compiled instruction set; those this processor lacks say so.
class EveryVariant : public testing::TestWithParam<const Variant*> {
 protected:
  void SetUp() override {
    if (!GetParam()->is_supported())
      GTEST_SKIP() << "this processor has no " << GetParam()->name;
  }
  const Variant& variant() const { return *GetParam(); }
};

inline std::string isa_name(const testing::TestParamInfo<const Variant*>& info) {
  return std::string(info.param->name);
}

/// Put once into each file with tests of a fixture `name` that derives from EveryVariant.
#define GRELHA_FOR_EVERY_ISA(name) \
  INSTANTIATE_TEST_SUITE_P(        \
      Isa, name, testing::ValuesIn(variants().begin(), variants().end()), isa_name)

}  // namespace grelha::test
