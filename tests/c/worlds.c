// Worlds: of floats and of doubles, copied, freed, moved.
#include <stdlib.h>

#include "check.h"
#include "shapes.h"

/// t of the nearest hit.
static float t_of(const grelha_world* world, const float* org, const float* dir) {
  float t = -1;
  const grelha_rays ray = one_ray(org, dir);
  const grelha_hits hits = {.t = &t};
  CHECK_OK(grelha_closest(world, &ray, &hits, 1));
  return t;
}

static const float above[] = {.25f, .5f, 5}, down[] = {0, 0, -1};

static void test_copies(void) {
  // vertices 50 bytes apart, as in STL, at an odd address
  char bytes[1 + 50 * kCorners] = {0};
  uint32_t indices[3 * kFaces];
  for (int i = 0; i < kCorners; ++i)
    memcpy(bytes + 1 + 50 * i, cube_corners + 3 * i, 12);
  memcpy(indices, cube_indices, sizeof indices);
  grelha_world* cube = NULL;
  const float* const odd = (const float*)(const void*)(bytes + 1);
  CHECK_OK(grelha_new_triangles(odd, 50, kCorners, indices, kFaces, 0, &cube));
  memset(bytes, 0x55, sizeof bytes);
  memset(indices, 0x55, sizeof indices);
  CHECK(t_of(cube, above, down) == 4);
  double offset[3] = {1, 1, 1};
  CHECK_OK(grelha_offset(cube, offset));
  CHECK(offset[0] == 0 && offset[1] == 0 && offset[2] == 0);
  grelha_free(cube);
}

/// From the last vertex to the first.
static void test_backwards(void) {
  uint32_t indices[3 * kFaces];
  for (int i = 0; i < 3 * kFaces; ++i)
    indices[i] = kCorners - 1 - cube_indices[i];
  grelha_world* cube = NULL;
  CHECK_OK(grelha_new_triangles(
      cube_corners + 3 * (kCorners - 1), -12, kCorners, indices, kFaces, 1, &cube));
  float t[2], u[2], v[2];
  uint32_t id[2], same[2];
  const float origins[] = {.25f, .5f, 5, 5, .25f, .5f}, directions[] = {0, 0, -1, -1, 0, 0};
  const grelha_rays rays = {
      .count = 2, .org = origins, .org_stride = 12, .dir = directions, .dir_stride = 12};
  const grelha_hits hits = {t, id, u, v}, again = {NULL, same, NULL, NULL};
  CHECK_OK(grelha_closest(cube, &rays, &hits, 1));
  CHECK(t[0] == 4 && t[1] == 4);
  grelha_world* const straight = new_cube();
  CHECK_OK(grelha_closest(straight, &rays, &again, 1));
  CHECK(id[0] == same[0] && id[1] == same[1]);
  grelha_free(straight);
  grelha_free(cube);
}

static void test_empty(void) {
  grelha_world* nothing = NULL;
  CHECK_OK(grelha_new_triangles(NULL, 0, 0, NULL, 0, 1, &nothing));
  CHECK(nothing && t_of(nothing, above, down) == INFINITY);
  CHECK_OK(grelha_update(nothing, NULL, 0, 0, 1));
  grelha_free(nothing);
  CHECK_OK(grelha_new_spheres(NULL, 0, NULL, 0, 1, &nothing));
  CHECK(nothing && t_of(nothing, above, down) == INFINITY);
  grelha_free(nothing);
}

void test_worlds(void) {
  CHECK(strcmp(grelha_version(), EXPECTED_VERSION) == 0);
  test_copies();
  test_backwards();
  test_empty();
  grelha_world* const ball = new_ball();
  const float org[] = {1, 2, 13};
  CHECK(t_of(ball, org, down) == 8);
  grelha_free(ball);
  // a vertex that no triangle names may be anything
  const float corners[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, NAN, INFINITY, 2e18f};
  const uint32_t indices[] = {0, 1, 2};
  grelha_world* one = NULL;
  CHECK_OK(grelha_new_triangles(corners, 12, 4, indices, 1, 1, &one));
  CHECK(t_of(one, above, down) == 5);
  grelha_free(one);
  grelha_free(NULL);
}

/// Adds to each corner of the cube.
static void fill_corners(double x, double y, double z, double* corners) {
  const double by[] = {x, y, z};
  for (int i = 0; i < 3 * kCorners; ++i)
    corners[i] = by[i % 3] + cube_corners[i];
}

static void test_triangles_in_double(void) {
  const double x = 500000.1, y = 4000000.3, z = -70000.7;
  double corners[3 * kCorners];
  double offset[3] = {0, 0, 0};
  fill_corners(x, y, z, corners);
  grelha_world* cube = NULL;
  CHECK_OK(grelha_new_triangles_double(corners, 24, kCorners, cube_indices, kFaces, 1, &cube));
  CHECK_OK(grelha_offset(cube, offset));
  CHECK(fabs(offset[0] - x) < 4 && fabs(offset[1] - y) < 4 && fabs(offset[2] - z) < 4);
  const float org[] = {(float)(x - offset[0]), (float)(y - offset[1]), (float)(z + 5 - offset[2])};
  CHECK(fabs(t_of(cube, org, down) - 4.) < 1e-5);
  // moved up by a quarter; the offset stays
  fill_corners(x, y, z + .25, corners);
  CHECK_OK(grelha_update_double(cube, corners, 24, kCorners, 1));
  CHECK(fabs(t_of(cube, org, down) - 3.75) < 1e-5);
  double later[3];
  CHECK_OK(grelha_offset(cube, later));
  CHECK(memcmp(offset, later, sizeof offset) == 0);
  // floats count from the offset
  float local[3 * kCorners];
  for (int i = 0; i < 3 * kCorners; ++i)
    local[i] = (float)(corners[i] - offset[i % 3]);
  CHECK_OK(grelha_update(cube, local, 12, kCorners, 1));
  CHECK(fabs(t_of(cube, org, down) - 3.75) < 1e-5);
  grelha_free(cube);
}

void test_doubles(void) {
  test_triangles_in_double();
  // near the origin floats resolve a millionth of the size
  double corners[3 * kCorners];
  double offset[3] = {1, 1, 1};
  fill_corners(2.1, 0, 0, corners);
  grelha_world* world = NULL;
  CHECK_OK(grelha_new_triangles_double(corners, 24, kCorners, cube_indices, kFaces, 1, &world));
  CHECK_OK(grelha_offset(world, offset));
  CHECK(offset[0] == 0 && offset[1] == 0 && offset[2] == 0);
  grelha_free(world);
  // two balls; 32 bytes a center
  const double centers[] = {1e7 + .1, 0, 0, 9, 1e7 + 10.1, 0, 0, 9}, radii[] = {1, 2};
  CHECK_OK(grelha_new_spheres_double(centers, 32, radii, 2, 1, &world));
  CHECK_OK(grelha_offset(world, offset));
  CHECK(fabs(offset[0] - 1e7) < 64 && offset[1] == 0 && offset[2] == 0);
  const float org[] = {(float)(centers[4] - offset[0]), 0, 5};
  CHECK(fabs(t_of(world, org, down) - 3.) < 1e-6);
  grelha_free(world);
}

/// Nearest hits of 33 x 33 rays from above.
static void shoot(const grelha_world* world, float* t, uint32_t* id) {
  enum { kSide = 33 };
  float origins[3 * kSide * kSide];
  for (int i = 0; i < kSide * kSide; ++i) {
    origins[3 * i] = -2 + .125f * (float)(i % kSide);
    origins[3 * i + 1] = -2 + .125f * (float)(i / kSide);
    origins[3 * i + 2] = 9;
  }
  const grelha_rays rays = {.count = kSide * kSide,
                            .org = origins,
                            .org_stride = 12,
                            .dir = down,
                            .dir_stride = GRELHA_SHARED};
  const grelha_hits hits = {.t = t, .id = id};
  CHECK_OK(grelha_closest(world, &rays, &hits, 1));
}

static void test_same_as_new(void) {
  enum { kRays = 33 * 33 };
  float moved[3 * kCorners], t[kRays], new_t[kRays];
  uint32_t id[kRays], new_id[kRays];
  for (int i = 0; i < 3 * kCorners; ++i)
    moved[i] = cube_corners[i] * (i % 3 == 0 ? 1.3f : .7f) + .1f * cube_corners[(i + 4) % 24];
  grelha_world* const cube = new_cube();
  grelha_world* fresh = NULL;
  CHECK_OK(grelha_new_triangles(moved, 12, kCorners, cube_indices, kFaces, 1, &fresh));
  shoot(cube, t, id);
  shoot(fresh, new_t, new_id);
  CHECK(memcmp(t, new_t, sizeof t) != 0);
  CHECK_OK(grelha_update(cube, moved, 12, kCorners, 2));
  memset(moved, 0x55, sizeof moved);
  shoot(cube, t, id);
  CHECK(memcmp(t, new_t, sizeof t) == 0 && memcmp(id, new_id, sizeof id) == 0);
  grelha_free(fresh);
  grelha_free(cube);
}

void test_updates(void) {
  test_same_as_new();
  float moved[3 * kCorners];
  for (int i = 0; i < 3 * kCorners; ++i)
    moved[i] = cube_corners[i] + (i % 3 == 2 ? 3.f : 0.f);
  grelha_world* const cube = new_cube();
  CHECK_OK(grelha_update(cube, moved, 12, kCorners, 1));
  CHECK(t_of(cube, above, down) == 1);
  // what fails leaves the world as it was
  moved[5] = NAN;
  CHECK_ERROR(
      grelha_update(cube, moved, 12, kCorners, 1), GRELHA_INVALID, "points: expected finite");
  CHECK_ERROR(grelha_update(cube, cube_corners, 12, kCorners - 1, 1), GRELHA_INVALID, "count: ");
  CHECK_ERROR(grelha_update(cube, cube_corners, 12, kCorners, -1), GRELHA_INVALID, "threads: ");
  CHECK_ERROR(grelha_update(cube, NULL, 12, kCorners, 1), GRELHA_INVALID, "points: ");
  CHECK_ERROR(grelha_update(cube, cube_corners, 0, kCorners, 1), GRELHA_INVALID, "points: ");
  CHECK(t_of(cube, above, down) == 1);
  grelha_free(cube);
  grelha_world* const ball = new_ball();
  const float center[] = {1, 2, 0}, org[] = {1, 2, 13};
  CHECK_OK(grelha_update(ball, center, 12, 1, 1));
  CHECK(t_of(ball, org, down) == 11);
  grelha_free(ball);
}
