// Several meshes in one world: whose hits they are, and changes of one.
#include <stdlib.h>

#include "check.h"
#include "shapes.h"

enum { kSide = 20, kSheetCorners = (kSide + 1) * (kSide + 1), kSheetFaces = 2 * kSide * kSide };

/// A wavy sheet of more than 256 triangles around (x, y, z).
typedef struct sheet {
  float corners[3 * kSheetCorners];
  uint32_t indices[3 * kSheetFaces];
} sheet;

static void fill_sheet(sheet* s, float x, float y, float z) {
  float* at = s->corners;
  uint32_t* index = s->indices;
  for (int j = 0; j <= kSide; ++j)
    for (int i = 0; i <= kSide; ++i) {
      *at++ = x - 1 + 2 * (float)i / kSide;
      *at++ = y - 1 + 2 * (float)j / kSide;
      *at++ = z + .125f * (float)((i * j) % 3);
    }
  for (uint32_t j = 0; j < kSide; ++j)
    for (uint32_t i = 0; i < kSide; ++i) {
      const uint32_t a = j * (kSide + 1) + i, b = a + kSide + 1;
      const uint32_t both[] = {a, a + 1, b, a + 1, b + 1, b};
      memcpy(index, both, sizeof both);
      index += 6;
    }
}

static grelha_mesh sheet_mesh(const sheet* s) {
  const grelha_mesh mesh = {.vertices = s->corners,
                            .stride = 12,
                            .vertex_count = kSheetCorners,
                            .indices = s->indices,
                            .triangle_count = kSheetFaces};
  return mesh;
}

static grelha_mesh cube_mesh(void) {
  const grelha_mesh mesh = {.vertices = cube_corners,
                            .stride = 12,
                            .vertex_count = kCorners,
                            .indices = cube_indices,
                            .triangle_count = kFaces};
  return mesh;
}

/// The mesh under a point, or GRELHA_NONE, and how far below z = 9 it is.
static uint32_t mesh_below(const grelha_world* world, float x, float y, float* t) {
  const float org[] = {x, y, 9}, down[] = {0, 0, -1};
  uint32_t id = 0, mesh = 0;
  const grelha_rays ray = one_ray(org, down);
  const grelha_hits hits = {.t = t, .id = &id};
  CHECK_OK(grelha_closest(world, &ray, &hits, 1));
  CHECK_OK(grelha_mesh_of(world, &id, 1, &mesh, NULL));
  return mesh;
}

static void test_mesh_numbers(const grelha_world* world) {
  const uint32_t ids[] = {
      0, kSheetFaces - 1, kSheetFaces, kSheetFaces + kFaces - 1, kSheetFaces + kFaces, GRELHA_NONE};
  const uint32_t meshes[] = {0, 0, 1, 1, 3, GRELHA_NONE};
  const uint32_t rows[] = {0, kSheetFaces - 1, 0, kFaces - 1, 0, GRELHA_NONE};
  uint32_t mesh[6], triangle[6];
  CHECK_OK(grelha_mesh_of(world, ids, 6, mesh, triangle));
  CHECK(memcmp(mesh, meshes, sizeof mesh) == 0 && memcmp(triangle, rows, sizeof rows) == 0);
}

/// Updates of one mesh give the bits of a new world.
static void test_moves(grelha_world* world, const grelha_mesh* meshes, sheet* moved) {
  enum { kRays = 30 * 30 };
  float origins[3 * kRays], t[kRays], new_t[kRays];
  uint32_t id[kRays], new_id[kRays];
  const float down[] = {.1f, .05f, -1};
  for (int i = 0; i < kRays; ++i) {
    origins[3 * i] = -2 + .25f * (float)(i % 30);
    origins[3 * i + 1] = -2 + .125f * (float)(i / 30);
    origins[3 * i + 2] = 9;
  }
  const grelha_rays rays = {
      .count = kRays, .org = origins, .org_stride = 12, .dir = down, .dir_stride = GRELHA_SHARED};
  for (int step = 0; step < 5; ++step) {
    fill_sheet(moved, 4, 0, .25f * (float)step);
    grelha_world* fresh = NULL;
    CHECK_OK(grelha_new_meshes(meshes, 4, 1, &fresh));
    CHECK_OK(grelha_update_mesh(world, 3, &meshes[3], 1));
    CHECK_OK(grelha_closest(world, &rays, &(grelha_hits){.t = t, .id = id}, 1));
    CHECK_OK(grelha_closest(fresh, &rays, &(grelha_hits){.t = new_t, .id = new_id}, 1));
    CHECK(memcmp(t, new_t, sizeof t) == 0 && memcmp(id, new_id, sizeof id) == 0);
    float under = 0;
    CHECK(mesh_below(world, 4, .05f, &under) == 3 && under <= 9 - .25f * (float)step);
    grelha_free(fresh);
  }
}

static void test_visible(grelha_world* world) {
  float t = 0;
  uint8_t inside = 0;
  const float middle[] = {0, 0, 0};
  CHECK(mesh_below(world, .25f, .5f, &t) == 1 && t == 8);
  // a sheet is not closed, but not there
  CHECK_ERROR(grelha_contains(world, middle, 12, 1, GRELHA_CLOSED, &inside, 1),
              GRELHA_NOT_CLOSED,
              "inside: expected a closed mesh");
  CHECK_OK(grelha_set_visible(world, 0, 0, 1));
  CHECK_OK(grelha_set_visible(world, 3, 0, 1));
  CHECK_OK(grelha_contains(world, middle, 12, 1, GRELHA_CLOSED, &inside, 1));
  CHECK(inside == 1);
  CHECK(mesh_below(world, 4, 0, &t) == GRELHA_NONE && t == INFINITY);
  CHECK_OK(grelha_set_visible(world, 1, 0, 1));
  CHECK(mesh_below(world, .25f, .5f, &t) == GRELHA_NONE);
  for (size_t i = 0; i < 4; ++i)
    CHECK_OK(grelha_set_visible(world, i, 5, 1));
  CHECK(mesh_below(world, .25f, .5f, &t) == 1 && mesh_below(world, 4, 0, &t) == 3);
}

static void test_additions(grelha_world* world) {
  float t = 0;
  size_t number = 0;
  double corners[3 * kCorners];
  for (int i = 0; i < 3 * kCorners; ++i)
    corners[i] = cube_corners[i] + (i % 3 == 0 ? 8 : 0);
  const grelha_mesh cube = {.doubles = corners,
                            .stride = 24,
                            .vertex_count = kCorners,
                            .indices = cube_indices,
                            .triangle_count = kFaces};
  CHECK_OK(grelha_add_mesh(world, &cube, 1, &number));
  CHECK(number == 4 && mesh_below(world, 8.25f, .5f, &t) == 4 && t == 8);
  CHECK_OK(grelha_add_mesh(world, &cube, 1, NULL));
  CHECK(mesh_below(world, 8.25f, .5f, &t) == 4);
  CHECK_OK(grelha_set_visible(world, 4, 0, 1));
  CHECK(mesh_below(world, 8.25f, .5f, &t) == 5);
  // a world of one mesh becomes one of two
  grelha_world* const one = new_cube();
  CHECK_OK(grelha_add_mesh(one, &cube, 1, &number));
  CHECK(number == 1 && mesh_below(one, 8.25f, .5f, &t) == 1 && mesh_below(one, 0, .5f, &t) == 0);
  grelha_free(one);
}

static void test_offsets(void) {
  double corners[3 * kCorners], offset[3];
  for (int i = 0; i < 3 * kCorners; ++i)
    corners[i] = cube_corners[i] + 5e6;
  grelha_mesh cubes[] = {cube_mesh(), cube_mesh()};
  cubes[0].vertices = NULL;
  cubes[0].doubles = corners;
  cubes[0].stride = 24;
  cubes[1] = cubes[0];
  grelha_world* world = NULL;
  CHECK_OK(grelha_new_meshes(cubes, 2, 1, &world));
  CHECK_OK(grelha_offset(world, offset));
  CHECK(fabs(offset[0] - 5e6) < 8);
  for (int i = 0; i < kCorners; ++i)
    corners[3 * i] += 4.125;
  CHECK_OK(grelha_update_mesh(world, 1, &cubes[1], 1));
  float t = 0;
  const float y = (float)(5e6 - offset[1]), x = (float)(5e6 + 4.25 - offset[0]);
  CHECK(mesh_below(world, x, y, &t) == 1 && mesh_below(world, x - 4, y, &t) == 0);
  grelha_free(world);
}

/// The offset of a world that held nothing, or something else, follows what it holds.
static void test_offset_follows(void) {
  double corners[3 * kCorners], offset[3];
  for (int i = 0; i < 3 * kCorners; ++i)
    corners[i] = cube_corners[i] + 5e6;
  grelha_mesh cube = cube_mesh();
  grelha_world* worlds[] = {NULL, NULL, new_cube()};
  CHECK_OK(grelha_new_meshes(NULL, 0, 1, &worlds[0]));
  CHECK_OK(grelha_new_meshes(&cube, 1, 1, &worlds[1]));
  cube.vertices = NULL;
  cube.doubles = corners;
  cube.stride = 24;
  CHECK_OK(grelha_add_mesh(worlds[0], &cube, 1, NULL));
  CHECK_OK(grelha_update_mesh(worlds[1], 0, &cube, 1));
  CHECK_OK(grelha_update_double(worlds[2], corners, 24, kCorners, 1));
  for (int i = 0; i < 3; ++i) {
    CHECK_OK(grelha_offset(worlds[i], offset));
    CHECK(fabs(offset[0] - 5e6) < 8 && fabs(offset[2] - 5e6) < 8);
    grelha_free(worlds[i]);
  }
}

void test_meshes(void) {
  sheet* const sheets = malloc(2 * sizeof *sheets);
  fill_sheet(&sheets[0], 0, 0, -3);
  fill_sheet(&sheets[1], 4, 0, 0);
  const grelha_mesh nothing = {.vertices = NULL};
  const grelha_mesh meshes[] = {
      sheet_mesh(&sheets[0]), cube_mesh(), nothing, sheet_mesh(&sheets[1])};
  grelha_world* world = NULL;
  CHECK_OK(grelha_new_meshes(meshes, 4, 1, &world));
  test_mesh_numbers(world);
  test_moves(world, meshes, &sheets[1]);
  test_visible(world);
  test_additions(world);
  test_offsets();
  test_offset_follows();
  grelha_free(world);
  CHECK_OK(grelha_new_meshes(NULL, 0, 1, &world));
  float t = 0;
  CHECK(mesh_below(world, 0, 0, &t) == GRELHA_NONE);
  grelha_free(world);
  free(sheets);
}

void test_mesh_errors(void) {
  grelha_mesh meshes[] = {cube_mesh(), cube_mesh()};
  grelha_world* world = NULL;
  CHECK_OK(grelha_new_meshes(meshes, 2, 1, &world));
  grelha_world* none = world;
  const uint32_t beyond[] = {0, 1, 8}, id = 24;
  uint32_t mesh = 0;
  float broken[3 * kCorners], t = 0;
  memcpy(broken, cube_corners, sizeof broken);
  broken[5] = NAN;
  meshes[1].indices = beyond;
  CHECK_ERROR(grelha_new_meshes(meshes, 2, 1, &none),
              GRELHA_INVALID,
              "mesh 1: indices: expected numbers below 8, found 8 in triangle 0");
  CHECK(none == NULL);
  meshes[1] = cube_mesh();
  meshes[1].doubles = (const double*)(const void*)&t;
  CHECK_ERROR(grelha_new_meshes(meshes, 2, 1, &none), GRELHA_INVALID, "mesh 1: vertices: ");
  meshes[1] = cube_mesh();
  meshes[1].stride = 0;
  CHECK_ERROR(grelha_new_meshes(meshes, 2, 1, &none), GRELHA_INVALID, "mesh 1: vertices: ");
  meshes[1] = cube_mesh();
  meshes[1].triangle_count = SIZE_MAX;
  CHECK_ERROR(grelha_new_meshes(meshes, 2, 1, &none), GRELHA_TOO_MANY, "mesh 1: triangle_count: ");
  CHECK_ERROR(grelha_new_meshes(NULL, 2, 1, &none), GRELHA_INVALID, "meshes: ");
  CHECK_ERROR(grelha_new_meshes(meshes, 1, 1, NULL), GRELHA_INVALID, "world: ");
  CHECK_ERROR(
      grelha_mesh_of(world, &id, 1, &mesh, NULL), GRELHA_INVALID, "ids: expected ids below");
  CHECK_ERROR(grelha_mesh_of(world, NULL, 1, &mesh, NULL), GRELHA_INVALID, "ids: ");
  meshes[1] = cube_mesh();
  CHECK_ERROR(grelha_update_mesh(world, 2, &meshes[1], 1),
              GRELHA_INVALID,
              "mesh: expected less than 2, found 2");
  CHECK_ERROR(grelha_update_mesh(NULL, 1, &meshes[1], 1), GRELHA_INVALID, "world: ");
  CHECK_ERROR(grelha_update_mesh(world, 1, NULL, 1), GRELHA_INVALID, "mesh: ");
  meshes[1].vertices = broken;
  CHECK_ERROR(
      grelha_update_mesh(world, 1, &meshes[1], 1), GRELHA_INVALID, "vertices: expected fin");
  meshes[1].vertices = NULL;
  CHECK_ERROR(grelha_update_mesh(world, 1, &meshes[1], 1), GRELHA_INVALID, "vertices: ");
  meshes[1] = cube_mesh();
  meshes[1].vertex_count = 7;
  CHECK_ERROR(grelha_update_mesh(world, 1, &meshes[1], 1), GRELHA_INVALID, "count: ");
  CHECK_ERROR(grelha_set_visible(world, 2, 0, 1), GRELHA_INVALID, "mesh: expected less than 2");
  CHECK_ERROR(grelha_add_mesh(world, NULL, 1, NULL), GRELHA_INVALID, "mesh: ");
  meshes[0].vertices = broken;
  CHECK_ERROR(
      grelha_add_mesh(world, &meshes[0], 1, NULL), GRELHA_INVALID, "vertices: expected fin");
  CHECK(mesh_below(world, .25f, .5f, &t) == 0 && t == 8);
  grelha_free(world);
  grelha_world* const ball = new_ball();
  meshes[0] = cube_mesh();
  CHECK_ERROR(grelha_add_mesh(ball, &meshes[0], 1, NULL), GRELHA_INVALID, "world: ");
  CHECK_ERROR(grelha_update_mesh(ball, 0, &meshes[0], 1), GRELHA_INVALID, "world: ");
  CHECK_ERROR(grelha_set_visible(ball, 0, 0, 1), GRELHA_INVALID, "world: ");
  grelha_free(ball);
}

/// Cubes in a row, 4 apart.
static void new_row(grelha_world** world, int from, int count) {
  float corners[4][3 * kCorners];
  grelha_mesh cubes[4];
  for (int i = 0; i < count; ++i) {
    cubes[i] = cube_mesh();
    cubes[i].vertices = corners[i];
    for (int k = 0; k < 3 * kCorners; ++k)
      corners[i][k] = cube_corners[k] + (k % 3 == 0 ? 4.f * (float)(from + i) : 0);
  }
  CHECK_OK(grelha_new_meshes(cubes, (size_t)count, 1, world));
}

/// Ids, numbers and masks of those behind move up, and what comes after takes their place.
void test_removals(void) {
  grelha_world* world = NULL;
  uint8_t masks[4 * kFaces];
  float t = 0;
  size_t count = 0;
  new_row(&world, 0, 4);
  for (int i = 0; i < 4 * kFaces; ++i)
    masks[i] = i / kFaces == 2 ? 1 : 2;
  CHECK_OK(grelha_set_masks(world, masks, 4 * kFaces));
  CHECK_OK(grelha_mesh_count(world, &count));
  CHECK(count == 4 && mesh_below(world, 8.25f, .5f, &t) == 2);
  CHECK_OK(grelha_remove_mesh(world, 1, 1));
  CHECK_OK(grelha_mesh_count(world, &count));
  CHECK(count == 3 && mesh_below(world, 8.25f, .5f, &t) == 1 && t == 8);
  CHECK(mesh_below(world, 4.25f, .5f, &t) == GRELHA_NONE && mesh_below(world, 12, .5f, &t) == 2);
  const float org[] = {8.25f, .5f, 9}, down[] = {0, 0, -1};
  const uint8_t second = 2;
  uint32_t id = 0;
  grelha_rays ray = one_ray(org, down);
  ray.mask = &second;
  CHECK_OK(grelha_closest(world, &ray, &(grelha_hits){.id = &id}, 1));
  CHECK(id == GRELHA_NONE);
  const grelha_mesh cube = cube_mesh();
  CHECK_OK(grelha_add_mesh(world, &cube, 1, &count));
  CHECK(count == 3);
  for (int i = 0; i < 4; ++i)
    CHECK_OK(grelha_remove_mesh(world, 0, 1));
  CHECK_OK(grelha_mesh_count(world, &count));
  CHECK(count == 0 && mesh_below(world, 0, .5f, &t) == GRELHA_NONE);
  CHECK_ERROR(grelha_remove_mesh(world, 0, 1), GRELHA_INVALID, "mesh: expected less than 0");
  CHECK_ERROR(grelha_remove_mesh(NULL, 0, 1), GRELHA_INVALID, "world: ");
  CHECK_ERROR(grelha_mesh_count(world, NULL), GRELHA_INVALID, "count: ");
  CHECK_ERROR(grelha_mesh_count(NULL, &count), GRELHA_INVALID, "world: ");
  grelha_free(world);
  // a mesh alone in its world
  world = new_cube();
  CHECK_OK(grelha_remove_mesh(world, 0, 1));
  CHECK_OK(grelha_mesh_count(world, &count));
  CHECK(count == 0 && mesh_below(world, 0, .5f, &t) == GRELHA_NONE);
  grelha_free(world);
  // many at once
  float up[2][3 * kCorners];
  grelha_mesh moved[] = {cube_mesh(), cube_mesh()};
  const size_t numbers[] = {2, 0}, twice[] = {2, 2};
  new_row(&world, 0, 4);
  for (int i = 0; i < 6 * kCorners; ++i)
    up[i / 24][i % 24] = cube_corners[i % 24] + (float)(i % 3 == 2 ? 5 : 20 * (i / 24));
  moved[0].vertices = up[0];
  moved[1].vertices = up[1];
  CHECK_OK(grelha_update_meshes(world, numbers, moved, 2, 1));
  CHECK(mesh_below(world, .25f, .5f, &t) == 2 && mesh_below(world, 4.25f, .5f, &t) == 1);
  CHECK_OK(grelha_update_meshes(world, NULL, NULL, 0, 1));
  CHECK_ERROR(grelha_update_meshes(world, twice, moved, 2, 1),
              GRELHA_INVALID,
              "mesh: expected each once, found 2 twice");
  CHECK_ERROR(grelha_update_meshes(world, NULL, moved, 2, 1), GRELHA_INVALID, "numbers: ");
  CHECK_ERROR(grelha_update_meshes(world, numbers, NULL, 2, 1), GRELHA_INVALID, "mesh: ");
  grelha_free(world);
}
