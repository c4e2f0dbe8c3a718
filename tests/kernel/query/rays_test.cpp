// Views of the caller's arrays: whatever lies where, a ray is told what it is told alone, and
// nothing but the answers is written.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "grelha/grelha.hpp"
#include "tests/support/rays.hpp"
#include "tests/support/scenes.hpp"

namespace grelha::test {
namespace {

constexpr int kPackets[] = {1, 16, 64, 256};

/// Rays from within, from near, from so far that the kernel moves them, and some that hit nothing
/// whatever they point at.
std::vector<Ray> mixed_rays() {
  Random random(31);
  RayList list = rays_about(random, {}, 1, kManyRays);
  list.add(rays_about(random, {}, 1e5, 300));
  list.add({1e6f, 2e6f, -3e6f}, {-1, -2, 3});
  list = with_odd_values(random, list, .02);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < list.size(); ++i)
    rays.push_back({list.org(i), list.dir(i), list.t_min[i], list.t[i]});
  return rays;
}

Scene mixed_scene() {
  Scene scene = random_mixture(32, 500);
  scene.geometry.planes.add({0, 0, -3}, {0, 1, 8}, 0);
  return scene;
}

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

/// The answers to single-ray calls.
struct Alone {
  std::vector<Hit> hits;
  std::vector<std::uint8_t> blocked;
  Alone(const World& world, const std::vector<Ray>& rays) {
    for (const Ray& ray : rays) {
      hits.push_back(closest(world, ray));
      blocked.push_back(occluded(world, ray));
    }
  }
};

/// Asks the rays of a view with every packet size.
void expect_alone(const World& world, const Rays& view, const Alone& alone, const char* what) {
  ASSERT_EQ(view.count, alone.hits.size()) << what;
  for (const int packet : kPackets) {
    std::vector<Hit> hits(view.count, Hit{77, 77});
    std::vector<std::uint8_t> blocked(view.count, 77);
    closest(world, view, Hits::of(hits), {.packet = packet});
    occluded(world, view, blocked.data(), {.packet = packet});
    EXPECT_TRUE(same_bits(hits, alone.hits)) << what << ", packets of " << packet;
    EXPECT_TRUE(same_bits(blocked, alone.blocked)) << what << ", packets of " << packet;
  }
}

struct Mixed {
  const Scene scene = mixed_scene();
  const World world{scene, {}};
  const std::vector<Ray> rays = mixed_rays();
  std::vector<Float3> org, dir;
  std::array<std::vector<float>, 8> arrays;  ///< one for each component
  Mixed() {
    for (const Ray& r : rays) {
      org.push_back(r.org);
      dir.push_back(r.dir);
      const float all[] = {r.org.x, r.org.y, r.org.z, r.dir.x, r.dir.y, r.dir.z, r.t_min, r.t_max};
      for (std::size_t k = 0; k < 8; ++k)
        arrays[k].push_back(all[k]);
    }
  }
  /// From element `first` of the arrays on.
  Rays view(std::size_t first = 0) const {
    const auto at = [&](std::size_t k) { return arrays[k].data() + first; };
    return {.org = {at(0), at(1), at(2)},
            .dir = {at(3), at(4), at(5)},
            .t_min = at(6),
            .t_max = at(7),
            .count = rays.size() - first};
  }
};

TEST(Views, OfAnyStrideAreToldTheSame) {
  const Mixed m;
  const Alone alone(m.world, m.rays);
  const auto met = std::count(alone.blocked.begin(), alone.blocked.end(), 1);
  ASSERT_GT(met, 200);
  ASSERT_LT(met, std::ptrdiff_t(m.rays.size()) - 200);
  expect_alone(m.world, m.view(), alone, "an array for each component");
  expect_alone(m.world, Rays::of(m.rays), alone, "an array of rays");

  Rays points = Rays::of(m.org, m.dir);
  EXPECT_EQ(points.org_stride, 3);
  points.t_min = m.arrays[6].data();
  points.t_max = m.arrays[7].data();
  expect_alone(m.world, points, alone, "x y z x y z");

  struct Wide {
    float org[3], unused, dir[5], t_min, more[4], t_max;
  };
  std::vector<Wide> wide;
  for (const Ray& r : m.rays)
    wide.push_back({{r.org.x, r.org.y, r.org.z},
                    kNaN,
                    {r.dir.x, kNaN, r.dir.y, kNaN, r.dir.z},
                    r.t_min,
                    {},
                    r.t_max});
  constexpr std::ptrdiff_t kWide = sizeof(Wide) / sizeof(float);
  const Rays apart{.org = {&wide[0].org[0], &wide[0].org[1], &wide[0].org[2]},
                   .dir = {&wide[0].dir[0], &wide[0].dir[2], &wide[0].dir[4]},
                   .t_min = &wide[0].t_min,
                   .t_max = &wide[0].t_max,
                   .count = wide.size(),
                   .org_stride = kWide,
                   .dir_stride = kWide,
                   .t_stride = kWide};
  expect_alone(m.world, apart, alone, "members of the caller's own struct");
}

TEST(Views, GoBackwardsAndShareWhatTheySay) {
  const Mixed m;
  std::vector<Ray> reversed(m.rays.rbegin(), m.rays.rend());
  Rays back = m.view();
  const std::size_t last = m.rays.size() - 1;
  for (int a = 0; a < 3; ++a) {
    back.org[a] += last;
    back.dir[a] += last;
  }
  back.t_min += last;
  back.t_max += last;
  back.org_stride = back.dir_stride = back.t_stride = -1;
  expect_alone(m.world, back, Alone(m.world, reversed), "backwards");

  const Ray eye{{.1f, .2f, 4}, {}, .5f, 100};
  std::vector<Ray> fan;
  for (const Float3& dir : m.dir)
    fan.push_back({eye.org, dir, eye.t_min, eye.t_max});
  Rays shared = Rays::of(m.dir, m.dir);
  shared.org[0] = &eye.org.x;
  shared.org[1] = &eye.org.y;
  shared.org[2] = &eye.org.z;
  shared.t_min = &eye.t_min;
  shared.t_max = &eye.t_max;
  shared.org_stride = shared.t_stride = 0;
  expect_alone(m.world, shared, Alone(m.world, fan), "one origin and interval for all");
}

TEST(Views, LeaveOutWhatHasANaturalDefault) {
  const Mixed m;
  std::vector<Ray> open = m.rays, ending = m.rays;
  for (std::size_t i = 0; i < m.rays.size(); ++i) {
    open[i] = {m.rays[i].org, m.rays[i].dir};
    ending[i].t_min = 0;
  }
  const Alone alone(m.world, open);
  expect_alone(m.world, Rays::of(m.org, m.dir), alone, "neither t_min nor t_max");
  Rays bare = m.view();
  bare.t_min = bare.t_max = nullptr;
  expect_alone(m.world, bare, alone, "the same of arrays");
  bare.t_max = m.arrays[7].data();
  expect_alone(m.world, bare, Alone(m.world, ending), "no t_min");
  const auto misses =
      std::count_if(alone.hits.begin(), alone.hits.end(), [](const Hit& h) { return !h; });
  EXPECT_GT(misses, 50);
  for (const Hit& h : alone.hits)
    EXPECT_TRUE(h || h.t == kInf);
}

TEST(Views, AnswerWhatIsAskedForAndNoMore) {
  const Mixed m;
  const std::size_t n = m.rays.size();
  std::vector<float> t(n + 1, 77), only_t(n, 77);
  std::vector<std::uint32_t> id(n + 1, 77), only_id(n, 77);
  std::vector<double> t_double(n + 1, 77), only_double(n, 77);
  std::vector<std::uint8_t> blocked(n + 1, 77);
  closest(m.world, m.view(), {t.data(), id.data(), t_double.data()});
  closest(m.world, m.view(), {.t = only_t.data()});
  closest(m.world, m.view(), {.id = only_id.data()});
  closest(m.world, m.view(), {.t_double = only_double.data()});
  closest(m.world, m.view(), {});
  occluded(m.world, m.view(), blocked.data());
  EXPECT_EQ(t[n], 77);
  EXPECT_EQ(id[n], 77u);
  EXPECT_EQ(t_double[n], 77);
  EXPECT_EQ(blocked[n], 77);
  t.pop_back();
  id.pop_back();
  EXPECT_TRUE(same_bits(only_t, t));
  EXPECT_EQ(only_id, id);
  t_double.pop_back();
  EXPECT_TRUE(same_bits(only_double, t_double));
  for (std::size_t i = 0; i < n; ++i) {
    const Float3& o = m.rays[i].org;
    if (std::max({std::abs(o.x), std::abs(o.y), std::abs(o.z)}) > 1e18f)
      continue;  // see sound()
    if (id[i] != kNoPrimitive) {
      ASSERT_LE(std::abs(t_double[i] - double{t[i]}), 0x1p-23 * std::abs(double{t[i]})) << i;
      continue;
    }
    ASSERT_EQ(std::bit_cast<std::uint32_t>(t[i]), std::bit_cast<std::uint32_t>(m.rays[i].t_max));
  }
}

TEST(Views, OfSeveralThreadsHaveAnswersInTheirPlaces) {
  const Mixed m;
  std::vector<Ray> rays;
  while (rays.size() < 20000)
    rays.insert(rays.end(), m.rays.begin(), m.rays.end());
  std::vector<std::uint32_t> skip(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i)
    skip[i] = i % 3 == 0 ? closest(m.world, rays[i]).id : kNoPrimitive;
  struct Answers {
    std::vector<float> u, v;
    std::vector<double> t_double;
    Answers(const World& world,
            const std::vector<Ray>& asked,
            const std::uint32_t* skips,
            int threads)
        : u(asked.size(), 77), v(asked.size(), 77), t_double(asked.size(), 77) {
      Rays view = Rays::of(asked);
      view.skip = skips;
      closest(world,
              view,
              {.t_double = t_double.data(), .u = u.data(), .v = v.data()},
              {.threads = threads});
    }
  };
  const Answers one(m.world, rays, skip.data(), 1);
  const Answers three(m.world, rays, skip.data(), 3);
  EXPECT_TRUE(same_bits(one.u, three.u));
  EXPECT_TRUE(same_bits(one.v, three.v));
  EXPECT_TRUE(same_bits(one.t_double, three.t_double));
  int hits = 0;
  for (std::size_t i = 0; i < rays.size(); i += 37) {
    const Hit alone = closest(m.world, rays[i], {.skip = skip[i]});
    hits += bool(alone);
    const bool is_told = alone && std::abs(alone.t) < 1e18f;
    ASSERT_TRUE(!is_told || static_cast<float>(one.t_double[i]) == alone.t) << i;
  }
  EXPECT_GT(hits, 50);
}

TEST(Views, LeaveTheCallersArraysAlone) {
  const Mixed m;
  const auto arrays = m.arrays;
  const std::vector<Ray> rays = m.rays;
  std::vector<Hit> hits(rays.size());
  std::vector<std::uint8_t> blocked(rays.size());
  for (const int packet : kPackets) {
    closest(m.world, m.view(), Hits::of(hits), {.packet = packet});
    occluded(m.world, m.view(), blocked.data(), {.packet = packet});
    closest(m.world, rays, hits, {.packet = packet});
    occluded(m.world, rays, blocked, {.packet = packet});
    for (std::size_t k = 0; k < arrays.size(); ++k)
      EXPECT_TRUE(same_bits(m.arrays[k], arrays[k])) << "array " << k << ", packets of " << packet;
    EXPECT_TRUE(same_bits(m.rays, rays)) << packet;
  }
}

/// A caller may give t_max away.
TEST(Views, TMayTakeThePlaceOfTMax) {
  const Mixed m;
  std::vector<Ray> rays = m.rays;
  Rays view = Rays::of(rays);
  const Hits in_place{.t = &rays[0].t_max, .stride = view.t_stride};
  closest(m.world, view, in_place);
  const Alone alone(m.world, m.rays);
  for (std::size_t i = 0; i < rays.size(); ++i)
    ASSERT_EQ(std::bit_cast<std::uint32_t>(rays[i].t_max),
              std::bit_cast<std::uint32_t>(alone.hits[i].t))
        << i;
}

/// Counts and places that end within a packet, from places that no register is aligned to.
TEST(Views, BeginAndEndAnywhere) {
  const Mixed m;
  const Alone alone(m.world, m.rays);
  for (const std::size_t first : {0, 1, 7, 255, 256, 1000})
    for (const std::size_t count : {0, 1, 2, 255, 256, 257}) {
      Rays view = m.view(first);
      view.count = count;
      std::vector<Hit> hits(count + 1, Hit{77, 77});
      closest(m.world, view, Hits::of(hits));
      for (std::size_t i = 0; i < count; ++i)
        ASSERT_EQ(std::memcmp(&hits[i], &alone.hits[first + i], sizeof(Hit)), 0)
            << first << " " << i;
      EXPECT_EQ(hits[count].id, 77u) << first << ", " << count;
    }
}

TEST(Views, OfNothingNeedNoArrays) {
  const Mixed m;
  EXPECT_NO_THROW(closest(m.world, Rays{}, Hits{}));
  EXPECT_NO_THROW(occluded(m.world, Rays{}, nullptr));
  EXPECT_NO_THROW(closest(m.world, std::vector<Ray>{}, std::span<Hit>{}));
  EXPECT_NO_THROW(occluded(m.world, std::vector<Ray>{}, std::span<std::uint8_t>{}));
  EXPECT_EQ(Rays::of(std::span<const Float3>{}, {}).count, 0u);
}

template <class Call>
std::string refusal(const Call& call) {
  try {
    call();
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "nothing thrown";
}

TEST(Views, RefuseWhatHasNoDefault) {
  const Mixed m;
  std::vector<Hit> hits(m.rays.size());
  std::vector<std::uint8_t> blocked(m.rays.size());
  const auto refused = [&](const Rays& rays) {
    const std::string one = refusal([&] { closest(m.world, rays, Hits::of(hits)); });
    EXPECT_EQ(one, refusal([&] { occluded(m.world, rays, blocked.data()); }));
    return one;
  };
  for (const int a : {0, 1, 2}) {
    const std::string axis(1, "xyz"[a]);
    Rays rays = m.view();
    rays.org[a] = nullptr;
    EXPECT_EQ(refused(rays), "rays: expected an array of " + axis + " of origins, found null");
    rays = m.view();
    rays.dir[a] = nullptr;
    EXPECT_EQ(refused(rays), "rays: expected an array of " + axis + " of directions, found null");
  }
  Rays rays = m.view();
  rays.count = std::size_t(-3);
  EXPECT_EQ(refused(rays),
            "rays: expected a count that memory can hold, found 18446744073709551613");
  EXPECT_EQ(refusal([&] { occluded(m.world, m.view(), nullptr); }),
            "occluded: expected an array of answers, found null");
  hits.pop_back();
  blocked.pop_back();
  const std::string n = std::to_string(m.rays.size()), less = std::to_string(hits.size());
  const std::string few = "expected an answer for each of " + n + " rays, found room for " + less;
  EXPECT_EQ(refusal([&] { closest(m.world, m.rays, hits); }), few);
  EXPECT_EQ(refusal([&] { occluded(m.world, m.rays, blocked); }), few);
  EXPECT_EQ(refusal([&] { (void)Rays::of(m.org, std::span(m.dir).first(5)); }),
            "rays: expected as many directions as origins, found 5 and " + n);
}

}  // namespace
}  // namespace grelha::test
