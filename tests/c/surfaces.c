// Surfaces at hits, rays that leave them, and calls that report and end.
#include <stdlib.h>

#include "check.h"
#include "shapes.h"

enum { kRays = 400 };

/// Rays from a grid of points towards (0, 0, 0), some of which miss.
static grelha_rays rays_inwards(float* org, float* dir) {
  for (int i = 0; i < kRays; ++i) {
    const float from[] = {-3 + .31f * (float)(i % 20), -3 + .29f * (float)(i / 20), 7};
    for (int a = 0; a < 3; ++a) {
      org[3 * i + a] = from[a];
      dir[3 * i + a] = (a == 2 ? -1.f : -.07f * from[a]);
    }
  }
  const grelha_rays rays = {
      .count = kRays, .org = org, .org_stride = 12, .dir = dir, .dir_stride = 12};
  return rays;
}

static float dot(const float* a, const float* b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Rays that leave upwards are free, those that go in meet the other side.
static void test_leaving(const grelha_world* world, const grelha_surface* at, const uint32_t* id) {
  float* const org = malloc(3 * kRays * sizeof *org);
  float* const dir = malloc(3 * kRays * sizeof *dir);
  uint32_t* const next = malloc(kRays * sizeof *next);
  for (int side = -1; side <= 1; side += 2) {
    for (int i = 0; i < 3 * kRays; ++i)
      dir[i] = (float)side * (at[i / 3].normal[i % 3] + .01f * (float)(i % 7 - 3));
    CHECK_OK(grelha_start(at, kRays, dir, 12, org));
    const grelha_rays rays = {
        .count = kRays, .org = org, .org_stride = 12, .dir = dir, .dir_stride = 12};
    CHECK_OK(grelha_closest(world, &rays, &(grelha_hits){.id = next}, 1));
    for (int i = 0; i < kRays; ++i)
      CHECK(id[i] == GRELHA_NONE || side > 0 ? next[i] == GRELHA_NONE : next[i] != GRELHA_NONE);
  }
  free(next);
  free(dir);
  free(org);
}

static void test_surfaces_of(grelha_world* world, int is_sphere) {
  float *const org = malloc(3 * kRays * sizeof *org), *const dir = malloc(3 * kRays * sizeof *dir);
  float t[kRays], u[kRays], v[kRays];
  uint32_t id[kRays];
  grelha_surface at[kRays], same[kRays];
  const grelha_rays rays = rays_inwards(org, dir);
  const grelha_hits hits = {.t = t, .id = id, .u = u, .v = v};
  CHECK_OK(grelha_closest(world, &rays, &hits, 1));
  CHECK_OK(grelha_surfaces(world, &rays, &hits, at, 2));
  int met = 0;
  for (int i = 0; i < kRays; ++i) {
    if (id[i] == GRELHA_NONE) {
      CHECK(isnan(at[i].point[0]) && at[i].normal[2] == 0);
      continue;
    }
    ++met;
    CHECK(fabsf(dot(at[i].normal, at[i].normal) - 1) < 1e-5f && at[i].offset > 0);
    CHECK(dot(at[i].normal, dir + 3 * i) < 0);
    for (int a = 0; a < 3; ++a)
      CHECK(fabsf(at[i].point[a] - (org[3 * i + a] + t[i] * dir[3 * i + a])) < 1e-5f);
  }
  CHECK(met > 50 && met < kRays);
  test_leaving(world, at, id);
  if (is_sphere) {
    const uint32_t ball = 0;
    CHECK_ERROR(grelha_surfaces_at(world, &ball, u, v, 1, same, 1),
                GRELHA_INVALID,
                "id: expected a triangle, found 0");
  } else {
    CHECK_OK(grelha_surfaces_at(world, id, u, v, kRays, same, 1));
    for (int i = 0; i < kRays; ++i)
      CHECK(id[i] == GRELHA_NONE ? isnan(same[i].point[0])
                                 : fabsf(same[i].point[2] - at[i].point[2]) < 1e-5f &&
                                       memcmp(same[i].normal, at[i].normal, 12) == 0);
    test_leaving(world, same, id);
  }
  free(dir);
  free(org);
}

void test_surfaces(void) {
  grelha_world *const cube = new_cube(), *const ball = new_ball();
  test_surfaces_of(cube, 0);
  test_surfaces_of(ball, 1);
  const float org[] = {.25f, .5f, 5}, down[] = {0, 0, -1}, u[] = {.25f, .9f}, v[] = {.25f, .2f};
  float t = 0, start[6];
  uint32_t id[] = {2, 12};
  grelha_surface at[2];
  const grelha_rays ray = one_ray(org, down);
  const grelha_hits hits = {.t = &t, .id = id}, no_id = {.t = &t}, no_t = {.id = id};
  CHECK_OK(grelha_surfaces(cube, &ray, &hits, at, 1));
  CHECK_ERROR(grelha_surfaces(NULL, &ray, &hits, at, 1), GRELHA_INVALID, "world: ");
  CHECK_ERROR(grelha_surfaces(cube, NULL, &hits, at, 1), GRELHA_INVALID, "rays: ");
  CHECK_ERROR(grelha_surfaces(cube, &ray, NULL, at, 1), GRELHA_INVALID, "hits: ");
  CHECK_ERROR(grelha_surfaces(cube, &ray, &no_id, at, 1), GRELHA_INVALID, "id: ");
  CHECK_ERROR(grelha_surfaces(cube, &ray, &no_t, at, 1), GRELHA_INVALID, "t: ");
  CHECK_ERROR(grelha_surfaces(cube, &ray, &hits, NULL, 1), GRELHA_INVALID, "surfaces: ");
  CHECK_ERROR(grelha_surfaces(cube, &ray, &hits, at, -1), GRELHA_INVALID, "threads: ");
  id[0] = 12;
  CHECK_ERROR(grelha_surfaces(cube, &ray, &hits, at, 1), GRELHA_INVALID, "no primitive");
  CHECK_ERROR(grelha_surfaces_at(cube, id, u, v, 1, at, 1), GRELHA_INVALID, "no primitive");
  id[0] = 2;
  CHECK_OK(grelha_surfaces_at(cube, id, u, v, 1, at, 1));
  CHECK_ERROR(grelha_surfaces_at(cube, id, u + 1, v + 1, 1, at, 1), GRELHA_INVALID, "u, v: exp");
  CHECK_ERROR(grelha_surfaces_at(NULL, id, u, v, 1, at, 1), GRELHA_INVALID, "world: ");
  CHECK_ERROR(grelha_surfaces_at(cube, NULL, u, v, 1, at, 1), GRELHA_INVALID, "ids: ");
  CHECK_ERROR(grelha_surfaces_at(cube, id, NULL, v, 1, at, 1), GRELHA_INVALID, "u: ");
  CHECK_ERROR(grelha_surfaces_at(cube, id, u, NULL, 1, at, 1), GRELHA_INVALID, "v: ");
  CHECK_ERROR(grelha_surfaces_at(cube, id, u, v, 1, NULL, 1), GRELHA_INVALID, "surfaces: ");
  CHECK_ERROR(grelha_start(NULL, 1, down, 12, start), GRELHA_INVALID, "surfaces: ");
  CHECK_ERROR(grelha_start(at, 1, NULL, 12, start), GRELHA_INVALID, "dir: ");
  CHECK_ERROR(grelha_start(at, 1, down, 12, NULL), GRELHA_INVALID, "origins: ");
  CHECK_ERROR(grelha_start(at, 2, down, 14, start), GRELHA_INVALID, "dir_stride: ");
  CHECK_OK(grelha_start(NULL, 0, NULL, 0, NULL));
  grelha_free(cube);
  grelha_free(ball);
}

/// Hears how far calls are, and ends them after some.
typedef struct listener {
  int calls, left;
  double last;
} listener;

static int hear(void* context, double done) {
  listener* const own = context;
  ++own->calls;
  CHECK(done >= own->last && done <= 1);
  own->last = done;
  return own->left-- > 0;
}

void test_progress(void) {
  enum { kMany = 300000 };
  float* const org = malloc(3 * kMany * sizeof *org);
  uint8_t* const blocked = malloc(kMany);
  size_t* const offset = malloc((kMany + 1) * sizeof *offset);
  for (int i = 0; i < 3 * kMany; ++i)
    org[i] = i % 3 == 2 ? 5 : (float)(i % 1000) * .003f - 1.5f;
  const float down[] = {0, 0, -1};
  const grelha_rays rays = {
      .count = kMany, .org = org, .org_stride = 12, .dir = down, .dir_stride = GRELHA_SHARED};
  grelha_world *cube = new_cube(), *none = cube;
  listener all = {0, 1 << 30, 0};
  grelha_set_progress(hear, &all);
  CHECK_OK(grelha_occluded(cube, &rays, blocked, 2));
  CHECK(all.calls > 0 && all.last == 1);
  all.last = 0;
  CHECK_OK(grelha_all_hits(cube, &rays, offset, NULL, NULL, 0, 1));
  CHECK(all.last == 1);
  listener few = {0, 0, 0};
  grelha_set_progress(hear, &few);
  CHECK_ERROR(grelha_occluded(cube, &rays, blocked, 2), GRELHA_STOPPED, "stopped");
  CHECK(few.calls == 1);
  few.last = 0;
  CHECK_ERROR(
      grelha_contains(cube, org, 12, kMany, GRELHA_CLOSED, blocked, 1), GRELHA_STOPPED, "stopped");
  few.last = 0;
  CHECK_ERROR(grelha_new_triangles(cube_corners, 12, kCorners, cube_indices, kFaces, 1, &none),
              GRELHA_STOPPED,
              "stopped");
  CHECK(none == NULL);
  float moved[3 * kCorners], at[] = {.25f, .5f, 5};
  for (int i = 0; i < 3 * kCorners; ++i)
    moved[i] = 2 * cube_corners[i];
  const grelha_mesh larger = {.vertices = moved,
                              .stride = 12,
                              .vertex_count = kCorners,
                              .indices = cube_indices,
                              .triangle_count = kFaces};
  few.last = 0;
  CHECK_ERROR(grelha_update(cube, moved, 12, kCorners, 1), GRELHA_STOPPED, "stopped");
  few.last = 0;
  CHECK_ERROR(grelha_update_mesh(cube, 0, &larger, 1), GRELHA_STOPPED, "stopped");
  few.last = 0;
  CHECK_ERROR(grelha_add_mesh(cube, &larger, 1, NULL), GRELHA_STOPPED, "stopped");
  few.last = 0;
  CHECK_ERROR(grelha_set_visible(cube, 0, 0, 1), GRELHA_STOPPED, "stopped");
  few.last = 0;
  CHECK_ERROR(grelha_remove_mesh(cube, 0, 1), GRELHA_STOPPED, "stopped");
  grelha_set_progress(NULL, NULL);
  float t = 0;
  const grelha_rays ray = one_ray(at, down);
  CHECK_OK(grelha_closest(cube, &ray, &(grelha_hits){.t = &t}, 1));
  CHECK(t == 4);
  grelha_free(cube);
  free(offset);
  free(blocked);
  free(org);
}
