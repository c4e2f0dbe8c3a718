// All hits: counted, listed, visited.
#include <stdlib.h>

#include "check.h"
#include "shapes.h"

/// From above, beside, below; the last begins inside.
static const float origins[] = {.25f, .5f, 5, 3, 0, 5, .25f, .5f, -5, .25f, .5f, 0};
static const float directions[] = {0, 0, -1, 0, 0, -1, 0, 0, 1, 0, 0, 1};
static const grelha_rays four = {
    .count = 4, .org = origins, .org_stride = 12, .dir = directions, .dir_stride = 12};

static void test_two_calls(const grelha_world* cube) {
  const size_t expected[] = {0, 2, 2, 4, 5};
  size_t offset[5] = {9, 9, 9, 9, 9};
  uint32_t counts[4];
  CHECK_OK(grelha_count_hits(cube, &four, counts, 1));
  CHECK(counts[0] == 2 && counts[1] == 0 && counts[2] == 2 && counts[3] == 1);
  CHECK_OK(grelha_all_hits(cube, &four, offset, NULL, NULL, 0, 1));
  CHECK(memcmp(offset, expected, sizeof offset) == 0);
  float t[5];
  uint32_t id[6] = {[5] = 77};
  CHECK_OK(grelha_all_hits(cube, &four, offset, t, id, 5, 2));
  CHECK(memcmp(offset, expected, sizeof offset) == 0);
  CHECK(t[0] == 4 && t[1] == 6 && t[2] == 4 && t[3] == 6 && t[4] == 1);
  CHECK(id[0] == 3 && id[1] < 2 && id[2] == id[1] && id[3] == 3 && id[4] == 3);
  CHECK(id[5] == 77);
  // either array alone
  CHECK_OK(grelha_all_hits(cube, &four, offset, NULL, id, 6, 1));
  CHECK_OK(grelha_all_hits(cube, &four, offset, t, NULL, 5, 1));
  // too little room: the offsets still say how much it takes
  memset(offset, 0, sizeof offset);
  id[4] = 77;
  CHECK_ERROR(grelha_all_hits(cube, &four, offset, t, id, 4, 1),
              GRELHA_TOO_MANY,
              "capacity: expected at least 5, found 4");
  CHECK(memcmp(offset, expected, sizeof offset) == 0);
  CHECK(id[4] == 77);
}

/// More rays than are listed at once.
static void test_many(const grelha_world* cube) {
  enum { kRays = 150000 };
  const grelha_rays rays = {.count = kRays,
                            .org = origins,
                            .org_stride = GRELHA_SHARED,
                            .dir = directions,
                            .dir_stride = GRELHA_SHARED};
  size_t* const offset = calloc(kRays + 1, sizeof *offset);
  float* const t = calloc(2 * kRays, sizeof *t);
  CHECK_OK(grelha_all_hits(cube, &rays, offset, t, NULL, 2 * kRays, 2));
  int wrong = 0;
  for (size_t i = 0; i < kRays; ++i)
    wrong += offset[i] != 2 * i || t[2 * i] != 4 || t[2 * i + 1] != 6;
  CHECK(wrong == 0 && offset[kRays] == 2 * kRays);
  // the room ends in the first part; the rest is counted
  memset(offset, 0, (kRays + 1) * sizeof *offset);
  CHECK_ERROR(grelha_all_hits(cube, &rays, offset, t, NULL, 10, 1), GRELHA_TOO_MANY, "300000");
  for (size_t i = 0; i <= kRays; ++i)
    wrong += offset[i] != 2 * i;
  CHECK(wrong == 0);
  free(t);
  free(offset);
}

/// Down along the diagonal of the cube's sides, and past its edge.
static void test_crossings(const grelha_world* cube) {
  const float org[] = {.5f, .5f, 5, 1, .5f, 5};
  const float dir[] = {0, 0, -1};
  const grelha_rays rays = {
      .count = 2, .org = org, .org_stride = 12, .dir = dir, .dir_stride = GRELHA_SHARED};
  size_t offset[3];
  CHECK_OK(grelha_crossings(cube, &rays, offset, NULL, NULL, NULL, 0, 1));
  CHECK(offset[1] == 2 && (offset[2] == 2 || offset[2] == 4));
  float t[4];
  uint32_t id[4];
  uint8_t enters[4];
  CHECK_OK(grelha_crossings(cube, &rays, offset, t, id, enters, 4, 1));
  CHECK(t[0] == 4 && t[1] == 6 && enters[0] + enters[1] == 1 && id[0] != id[1]);
  CHECK_ERROR(grelha_crossings(cube, &rays, offset, t, NULL, NULL, 1, 1),
              GRELHA_TOO_MANY,
              "capacity: expected at least");
}

void test_all_hits(void) {
  grelha_world* const cube = new_cube();
  test_crossings(cube);
  test_two_calls(cube);
  test_many(cube);
  const uint32_t skip[] = {3, 3, 3, 3};
  grelha_rays rays = four;
  rays.skip = skip;
  uint32_t counts[4];
  CHECK_OK(grelha_count_hits(cube, &rays, counts, 1));
  CHECK(counts[0] == 1 && counts[1] == 0 && counts[2] == 1 && counts[3] == 0);
  size_t offset = 7;
  const grelha_rays none = {0};
  CHECK_OK(grelha_all_hits(cube, &none, &offset, NULL, NULL, 0, 1));
  CHECK(offset == 0);
  CHECK_OK(grelha_count_hits(cube, &none, NULL, 1));
  grelha_free(cube);
  // in and out of the ball
  grelha_world* const ball = new_ball();
  const float org[] = {1, 2, 13}, dir[] = {0, 0, -1};
  const grelha_rays ray = one_ray(org, dir);
  float t[2];
  size_t ends[2];
  CHECK_OK(grelha_all_hits(ball, &ray, ends, t, NULL, 2, 1));
  CHECK(ends[1] == 2 && t[0] == 8 && t[1] == 12);
  grelha_free(ball);
}

/// Hits that were visited.
struct visits {
  int count, most_of_a_ray;
  size_t ray[8];
  float t[8];
  uint32_t id[8];
};

static int visit(void* context, size_t ray, float t, uint32_t id) {
  struct visits* const all = context;
  if (all->count < 8) {
    all->ray[all->count] = ray;
    all->t[all->count] = t;
    all->id[all->count] = id;
  }
  ++all->count;
  return all->most_of_a_ray > 1;
}

void test_each_hit(void) {
  grelha_world* const cube = new_cube();
  struct visits all = {.most_of_a_ray = 2};
  CHECK_OK(grelha_each_hit(cube, &four, visit, &all));
  CHECK(all.count == 5);
  CHECK(all.ray[0] == 0 && all.ray[1] == 0 && all.ray[2] == 2 && all.ray[3] == 2 &&
        all.ray[4] == 3);
  CHECK(all.t[0] == 4 && all.t[1] == 6 && all.t[4] == 1 && all.id[0] == 3 && all.id[1] < 2);
  struct visits first = {.most_of_a_ray = 1};
  CHECK_OK(grelha_each_hit(cube, &four, visit, &first));
  CHECK(first.count == 3 && first.ray[0] == 0 && first.ray[1] == 2 && first.ray[2] == 3);
  // from behind the first hit to before the last, without one triangle
  const float t_min[] = {4, 0, 0, 0}, t_max[] = {9, 9, 6, 9};
  const uint32_t skip[] = {GRELHA_NONE, 0, 0, 3};
  grelha_rays rays = four;
  rays.t_min = t_min;
  rays.t_max = t_max;
  rays.skip = skip;
  struct visits some = {.most_of_a_ray = 2};
  CHECK_OK(grelha_each_hit(cube, &rays, visit, &some));
  const int front = all.id[1] != 0;  // of ray 2, unless it is the triangle left out
  CHECK(some.count == 1 + front && some.ray[0] == 0 && some.t[0] == 6);
  grelha_free(cube);
}
