// What callers get wrong is refused by a code and a line that names it.
#include <pthread.h>
#include <stdlib.h>
#include <sys/resource.h>

#include "check.h"
#include "shapes.h"

static const float org[] = {0, 0, 5, 0, 0, 5}, dir[] = {0, 0, -1, 0, 0, -1};

static void test_new_triangles(void) {
  const uint32_t beyond[] = {0, 1, 8};
  const float nan[] = {0, 0, 0, 1, 0, 0, 0, NAN, 0}, far[] = {0, 0, 0, 1, 0, 0, 0, 2e18f, 0};
  const uint32_t three[] = {0, 1, 2};
  grelha_world* const before = new_cube();
  grelha_world* world = before;
  CHECK_ERROR(grelha_new_triangles(cube_corners, 12, 8, beyond, 1, 1, &world),
              GRELHA_INVALID,
              "indices: expected numbers below 8, found 8 in triangle 0");
  CHECK(world == NULL);
  grelha_free(before);
  CHECK_ERROR(grelha_new_triangles(NULL, 12, 8, cube_indices, 12, 1, &world),
              GRELHA_INVALID,
              "vertices: expected a pointer, found null");
  CHECK_ERROR(grelha_new_triangles(cube_corners, 12, 8, NULL, 12, 1, &world),
              GRELHA_INVALID,
              "indices: expected a pointer, found null");
  CHECK_ERROR(grelha_new_triangles(cube_corners, 12, 8, cube_indices, 12, 1, NULL),
              GRELHA_INVALID,
              "world: ");
  CHECK_ERROR(grelha_new_triangles(cube_corners, 0, 8, cube_indices, 12, 1, &world),
              GRELHA_INVALID,
              "vertices: expected a stride of bytes from one to the next, found 0");
  CHECK_ERROR(grelha_new_triangles(nan, 12, 3, three, 1, 1, &world),
              GRELHA_INVALID,
              "vertices: expected finite numbers within 1e18, found nan in element 2");
  CHECK_ERROR(grelha_new_triangles(far, 12, 3, three, 1, 1, &world), GRELHA_INVALID, "vertices: ");
  CHECK_ERROR(grelha_new_triangles(cube_corners, 12, 8, cube_indices, 12, -1, &world),
              GRELHA_INVALID,
              "threads: expected 0 to 65536, found -1");
  // counts are judged before arrays are read
  CHECK_ERROR(grelha_new_triangles(cube_corners, 12, 8, cube_indices, 0xFFFFFFFF, 1, &world),
              GRELHA_TOO_MANY,
              "triangle_count: expected at most 4294967294, found 4294967295");
  CHECK_ERROR(grelha_new_triangles(cube_corners, 12, SIZE_MAX, cube_indices, 12, 1, &world),
              GRELHA_TOO_MANY,
              "vertex_count: ");
  CHECK(world == NULL);
}

static void test_new_spheres(void) {
  const float none = 0, nan = NAN, below = -1, one = 1, infinite = INFINITY;
  const float* const wrong[] = {&none, &nan, &below, &infinite};
  const double tiny = 1e-60, zeros[] = {0, 0, 0};
  const float beyond[] = {0, 0, INFINITY};
  grelha_world* world = NULL;
  for (int i = 0; i < 4; ++i)
    CHECK_ERROR(grelha_new_spheres(org, 12, wrong[i], 1, 1, &world),
                GRELHA_INVALID,
                "radii: expected numbers above 0 and within 1e18");
  CHECK_ERROR(grelha_new_spheres_double(zeros, 24, &tiny, 1, 1, &world), GRELHA_INVALID, "radii: ");
  CHECK_ERROR(grelha_new_spheres(beyond, 12, &one, 1, 1, &world), GRELHA_INVALID, "centers: ");
  CHECK_ERROR(grelha_new_spheres(org, 12, NULL, 1, 1, &world), GRELHA_INVALID, "radii: ");
  CHECK_ERROR(grelha_new_spheres(NULL, 12, &one, 1, 1, &world), GRELHA_INVALID, "centers: ");
  CHECK_ERROR(grelha_new_spheres(org, 12, &one, 0xFFFFFFFF, 1, &world), GRELHA_TOO_MANY, "count: ");
  CHECK(world == NULL);
}

static void test_rays(const grelha_world* cube) {
  float t[2];
  uint8_t blocked[2];
  const grelha_hits hits = {.t = t};
  const grelha_rays sound = {
      .count = 2, .org = org, .org_stride = 12, .dir = dir, .dir_stride = 12};
  grelha_rays rays = sound;
  CHECK_ERROR(grelha_closest(NULL, &rays, &hits, 1), GRELHA_INVALID, "world: ");
  CHECK_ERROR(grelha_closest(cube, NULL, &hits, 1), GRELHA_INVALID, "rays: ");
  CHECK_ERROR(grelha_closest(cube, &rays, NULL, 1), GRELHA_INVALID, "hits: ");
  CHECK_ERROR(grelha_closest(cube, &rays, &hits, 65537), GRELHA_INVALID, "threads: ");
  CHECK_ERROR(grelha_occluded(cube, &rays, NULL, 1), GRELHA_INVALID, "blocked: ");
  rays.org_stride = 0;
  CHECK_ERROR(grelha_closest(cube, &rays, &hits, 1), GRELHA_INVALID, "org_stride: ");
  rays = sound;
  rays.dir_stride = 14;
  CHECK_ERROR(grelha_occluded(cube, &rays, blocked, 1),
              GRELHA_INVALID,
              "dir_stride: expected a multiple of 4 bytes (12 for points that follow each other) "
              "or GRELHA_SHARED, found 14");
  rays = sound;
  rays.org = NULL;
  CHECK_ERROR(grelha_closest(cube, &rays, &hits, 1), GRELHA_INVALID, "org: ");
  rays = sound;
  rays.dir = NULL;
  CHECK_ERROR(grelha_closest(cube, &rays, &hits, 1), GRELHA_INVALID, "dir: ");
  rays.dir = (const float*)(const void*)((const char*)dir + 1);
  CHECK_ERROR(grelha_closest(cube, &rays, &hits, 1), GRELHA_INVALID, "dir: expected an address");
  rays = sound;
  rays.count = SIZE_MAX;
  CHECK_ERROR(grelha_closest(cube, &rays, &hits, 1), GRELHA_INVALID, "rays: expected a count");
}

static void test_all_hits_of(const grelha_world* cube) {
  const grelha_rays ray = one_ray(org, dir);
  size_t offset[2];
  CHECK_ERROR(grelha_count_hits(cube, &ray, NULL, 1), GRELHA_INVALID, "counts: ");
  CHECK_ERROR(grelha_count_hits(NULL, &ray, NULL, 1), GRELHA_INVALID, "world: ");
  CHECK_ERROR(grelha_all_hits(cube, &ray, NULL, NULL, NULL, 0, 1), GRELHA_INVALID, "offset: ");
  CHECK_ERROR(grelha_all_hits(NULL, &ray, offset, NULL, NULL, 0, 1), GRELHA_INVALID, "world: ");
  CHECK_ERROR(grelha_all_hits(cube, NULL, offset, NULL, NULL, 0, 1), GRELHA_INVALID, "rays: ");
  CHECK_ERROR(grelha_all_hits(cube, &ray, offset, NULL, NULL, 0, -1), GRELHA_INVALID, "threads: ");
  CHECK_ERROR(grelha_each_hit(cube, &ray, NULL, NULL), GRELHA_INVALID, "visit: ");
  CHECK_ERROR(grelha_each_hit(NULL, &ray, NULL, NULL), GRELHA_INVALID, "world: ");
}

static void test_points(const grelha_world* cube) {
  uint8_t inside;
  float d;
  CHECK_ERROR(
      grelha_contains(NULL, org, 12, 1, GRELHA_CLOSED, &inside, 1), GRELHA_INVALID, "world: ");
  CHECK_ERROR(
      grelha_contains(cube, NULL, 12, 1, GRELHA_CLOSED, &inside, 1), GRELHA_INVALID, "points: ");
  CHECK_ERROR(
      grelha_contains(cube, org, 0, 1, GRELHA_CLOSED, &inside, 1), GRELHA_INVALID, "points: ");
  CHECK_ERROR(
      grelha_contains(cube, org, 12, 1, GRELHA_CLOSED, NULL, 1), GRELHA_INVALID, "inside: ");
  CHECK_ERROR(
      grelha_contains(cube, org, 12, 1, GRELHA_CLOSED, &inside, -2), GRELHA_INVALID, "threads: ");
  CHECK_ERROR(grelha_closest_points(cube, org, 12, 1, NAN, NULL, &d, NULL, 1),
              GRELHA_INVALID,
              "radius: expected 0 or more, found nan");
  CHECK_ERROR(
      grelha_closest_points(cube, org, 12, 1, -1, NULL, &d, NULL, 1), GRELHA_INVALID, "radius: ");
  CHECK_ERROR(
      grelha_closest_points(NULL, org, 12, 1, 1, NULL, &d, NULL, 1), GRELHA_INVALID, "world: ");
  CHECK_ERROR(grelha_signed_distances(cube, org, 12, 1, GRELHA_CLOSED, NULL, 1),
              GRELHA_INVALID,
              "distance: ");
  CHECK_ERROR(
      grelha_signed_distances(NULL, org, 12, 1, GRELHA_CLOSED, &d, 1), GRELHA_INVALID, "world: ");
  CHECK_ERROR(grelha_contains(cube, org, 12, 1, (grelha_inside)4, &inside, 1),
              GRELHA_INVALID,
              "rule: expected 0 to 3, found 4");
  double number;
  CHECK_ERROR(grelha_winding_numbers(NULL, org, 12, 1, 1, &number, 1), GRELHA_INVALID, "world: ");
  CHECK_ERROR(grelha_winding_numbers(cube, org, 12, 1, 1, NULL, 1), GRELHA_INVALID, "numbers: ");
  grelha_mesh_check found;
  CHECK_ERROR(grelha_check_mesh(NULL, &found), GRELHA_INVALID, "world: ");
  CHECK_ERROR(grelha_check_mesh(cube, NULL), GRELHA_INVALID, "found: ");
}

void test_misuse(void) {
  double offset[3];
  grelha_world* const cube = new_cube();
  test_new_triangles();
  test_new_spheres();
  test_rays(cube);
  test_all_hits_of(cube);
  test_points(cube);
  CHECK_ERROR(grelha_offset(NULL, offset), GRELHA_INVALID, "world: ");
  CHECK_ERROR(grelha_offset(cube, NULL), GRELHA_INVALID, "offset: ");
  CHECK_ERROR(grelha_update(NULL, cube_corners, 12, 8, 1), GRELHA_INVALID, "world: ");
  CHECK_ERROR(grelha_update_double(NULL, offset, 24, 1, 1), GRELHA_INVALID, "world: ");
  grelha_free(cube);
}

static void* fail_elsewhere(void* cube) {
  CHECK(strcmp(grelha_last_error(), "") == 0);
  CHECK_ERROR(grelha_offset(cube, NULL), GRELHA_INVALID, "offset: ");
  return NULL;
}

void test_errors(void) {
  CHECK(strcmp(grelha_last_error(), "") == 0);
  grelha_world* const cube = new_cube();
  CHECK_ERROR(grelha_offset(NULL, NULL), GRELHA_INVALID, "world: ");
  pthread_t thread;
  CHECK(pthread_create(&thread, NULL, fail_elsewhere, cube) == 0);
  pthread_join(thread, NULL);
  CHECK(strstr(grelha_last_error(), "world: ") != NULL);  // neither another thread's
  double offset[3];
  CHECK_OK(grelha_offset(cube, offset));
  CHECK(strstr(grelha_last_error(), "world: ") != NULL);  // nor gone by what succeeds
  grelha_free(cube);
}

/// No more memory than the process has. Allocators of sanitizers would end it.
void test_memory(void) {
#ifndef SANITIZED
  enum { kCount = 1000000 };
  float* const centers = calloc(3 * kCount, sizeof *centers);
  float* const radii = calloc(kCount, sizeof *radii);
  for (int i = 0; i < kCount; ++i)
    radii[i] = 1;
  struct rlimit before, tight;
  CHECK(getrlimit(RLIMIT_AS, &before) == 0);
  tight = before;
  tight.rlim_cur = 1;
  CHECK(setrlimit(RLIMIT_AS, &tight) == 0);
  grelha_world* world = NULL;
  const grelha_status status = grelha_new_spheres(centers, 12, radii, kCount, 1, &world);
  CHECK(setrlimit(RLIMIT_AS, &before) == 0);
  CHECK_ERROR(status, GRELHA_NO_MEMORY, "memory");
  CHECK(world == NULL);
  free(radii);
  free(centers);
#endif
}
