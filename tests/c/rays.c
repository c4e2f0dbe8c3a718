// The nearest hit, and any hit.
#include "check.h"
#include "shapes.h"

/// The point of the cube's triangle `id` with these coordinates.
static void point_on(uint32_t id, float u, float v, float* point) {
  const float* corner[3];
  for (int k = 0; k < 3; ++k)
    corner[k] = cube_corners + 3 * cube_indices[3 * id + (uint32_t)k];
  for (int a = 0; a < 3; ++a)
    point[a] = (1 - u - v) * corner[0][a] + u * corner[1][a] + v * corner[2][a];
}

static void test_range_and_skip(const grelha_world* cube) {
  const float org[] = {.25f, .5f, 5}, dir[] = {0, 0, -2};
  const float t_min[] = {0, 2, 2.5f, 0, 0, 0}, t_max[] = {9, 9, 9, 2, 1, 9};
  const uint32_t skip[] = {GRELHA_NONE, GRELHA_NONE, GRELHA_NONE, GRELHA_NONE, GRELHA_NONE, 3};
  float t[6];
  uint32_t id[6];
  const grelha_rays rays = {.count = 6,
                            .org = org,
                            .org_stride = GRELHA_SHARED,
                            .dir = dir,
                            .dir_stride = GRELHA_SHARED,
                            .t_min = t_min,
                            .t_max = t_max,
                            .skip = skip};
  const grelha_hits hits = {.t = t, .id = id};
  CHECK_OK(grelha_closest(cube, &rays, &hits, 1));
  CHECK(t[0] == 2 && id[0] == 3);
  CHECK(t[1] == 3 && id[1] <= 1);
  CHECK(t[2] == 3 && id[2] == id[1]);
  CHECK(t[3] == 2 && id[3] == GRELHA_NONE);
  CHECK(t[4] == 1 && id[4] == GRELHA_NONE);
  CHECK(t[5] == 3 && id[5] == id[1]);
  uint8_t blocked[6];
  CHECK_OK(grelha_occluded(cube, &rays, blocked, 1));
  for (int i = 0; i < 6; ++i)
    CHECK(blocked[i] == (id[i] != GRELHA_NONE));
}

static void test_masks(grelha_world* cube) {
  const float org[] = {.25f, .5f, 5}, dir[] = {0, 0, -2};
  const uint8_t mask[] = {255, 1, 2, 4};
  uint8_t masks[12], blocked[4];
  uint32_t id[4], counts[4], ids[8];
  size_t offset[5];
  const grelha_rays rays = {.count = 4,
                            .org = org,
                            .org_stride = GRELHA_SHARED,
                            .dir = dir,
                            .dir_stride = GRELHA_SHARED,
                            .mask = mask};
  const grelha_hits hits = {.id = id};
  for (int i = 0; i < 12; ++i)
    masks[i] = i == 3 ? 2 : 1;
  CHECK(grelha_set_masks(cube, masks, 11) == GRELHA_INVALID);
  CHECK(grelha_set_masks(cube, NULL, 12) == GRELHA_INVALID);
  CHECK_OK(grelha_set_masks(cube, masks, 12));
  CHECK_OK(grelha_closest(cube, &rays, &hits, 1));
  CHECK(id[0] == 3 && id[1] <= 1 && id[2] == 3 && id[3] == GRELHA_NONE);
  CHECK_OK(grelha_occluded(cube, &rays, blocked, 1));
  CHECK(blocked[0] == 1 && blocked[1] == 1 && blocked[2] == 1 && blocked[3] == 0);
  CHECK_OK(grelha_count_hits(cube, &rays, counts, 1));
  CHECK(counts[0] == 2 && counts[1] == 1 && counts[2] == 1 && counts[3] == 0);
  CHECK_OK(grelha_all_hits(cube, &rays, offset, NULL, ids, 8, 1));
  CHECK(offset[4] == 4 && ids[0] == 3 && ids[1] == id[1] && ids[2] == id[1] && ids[3] == 3);
  CHECK_OK(grelha_set_masks(cube, NULL, 0));
  CHECK_OK(grelha_closest(cube, &rays, &hits, 1));
  CHECK(id[3] == 3);
}

/// Origins and directions of one struct, by more than one thread.
static void test_streams(const grelha_world* cube) {
  enum { kRays = 20000 };
  static struct { float org[3], weight, dir[3]; } record[kRays];
  static float t[kRays], u[kRays], v[kRays];
  static uint32_t id[kRays];
  for (int i = 0; i < kRays; ++i) {
    const float x = -1.5f + 3.f * (float)i / kRays;
    const float org[] = {x, .3f, 5}, dir[] = {0, 0, -1};
    memcpy(record[i].org, org, sizeof org);
    memcpy(record[i].dir, dir, sizeof dir);
  }
  const grelha_rays rays = {.count = kRays,
                            .org = record[0].org,
                            .org_stride = sizeof record[0],
                            .dir = record[0].dir,
                            .dir_stride = sizeof record[0]};
  const grelha_hits hits = {t, id, u, v};
  CHECK_OK(grelha_closest(cube, &rays, &hits, 2));
  int wrong = 0;
  for (int i = 0; i < kRays; ++i) {
    const float x = record[i].org[0];
    if (fabsf(x) > 1) {
      wrong += t[i] != INFINITY || id[i] != GRELHA_NONE || u[i] != 0 || v[i] != 0;
      continue;
    }
    float point[3];
    point_on(id[i] < kFaces ? id[i] : 0, u[i], v[i], point);
    wrong += t[i] != 4 || id[i] < 2 || id[i] > 3;
    wrong +=
        fabsf(point[0] - x) > 1e-6f || fabsf(point[1] - .3f) > 1e-6f || fabsf(point[2] - 1) > 1e-6f;
    wrong += u[i] < 0 || v[i] < 0 || u[i] + v[i] > 1;
  }
  CHECK(wrong == 0);
}

void test_closest(void) {
  grelha_world* const cube = new_cube();
  test_range_and_skip(cube);
  test_masks(cube);
  test_streams(cube);
  const grelha_rays none = {0};
  const grelha_hits unwanted = {0};
  CHECK_OK(grelha_closest(cube, &none, &unwanted, 0));
  const float org[] = {0, 0, 5}, along[] = {0, 0, -1}, zero[] = {0, 0, 0}, nan[] = {0, NAN, 1};
  grelha_rays ray = one_ray(org, along);
  CHECK_OK(grelha_closest(cube, &ray, &unwanted, 1));
  uint32_t id = 5;
  const grelha_hits hits = {.id = &id};
  ray.dir = zero;
  CHECK_OK(grelha_closest(cube, &ray, &hits, 1));
  CHECK(id == GRELHA_NONE);
  id = 5;
  ray.dir = nan;
  CHECK_OK(grelha_closest(cube, &ray, &hits, 1));
  CHECK(id == GRELHA_NONE);
  grelha_free(cube);
}

void test_occluded(void) {
  grelha_world* const ball = new_ball();
  const float org[] = {1, 2, 13, 1, 4.5f, 13, 1, 2, 13}, dir[] = {0, 0, -1};
  const float t_max[] = {9, 9, 7};
  uint8_t blocked[] = {9, 9, 9};
  const grelha_rays rays = {.count = 3,
                            .org = org,
                            .org_stride = 12,
                            .dir = dir,
                            .dir_stride = GRELHA_SHARED,
                            .t_max = t_max};
  CHECK_OK(grelha_occluded(ball, &rays, blocked, 0));
  CHECK(blocked[0] == 1 && blocked[1] == 0 && blocked[2] == 0);
  const grelha_rays none = {0};
  CHECK_OK(grelha_occluded(ball, &none, NULL, 1));
  grelha_free(ball);
}
