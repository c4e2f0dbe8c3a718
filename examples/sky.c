// The sky that a street sees: for each point of the ground the share of 256 directions above it, as
// the cosine weighs them, in which nothing is in the way. No epsilon: grelha_start() says where
// rays leave. With grelha installed: cc sky.c $(pkg-config --cflags --libs grelha-c) -lm -o sky
#include <grelha.h>
#include <math.h>
#include <stdio.h>

enum { kPoints = 9, kDirections = 256 };

static int failed(void) {
  fprintf(stderr, "sky: %s\n", grelha_last_error());
  return 1;
}

int main(void) {
  // The ground at z = 0, and a wall of height 3 along x = 1, each of two triangles.
  const float ground[] = {-9, -9, 0, 9, -9, 0, 9, 9, 0, -9, 9, 0};
  const float wall[] = {1, -9, 0, 1, 9, 0, 1, 9, 3, 1, -9, 3};
  const uint32_t square[] = {0, 1, 2, 0, 2, 3};
  const grelha_mesh meshes[] = {{ground, NULL, 12, 4, square, 2}, {wall, NULL, 12, 4, square, 2}};
  grelha_world* world;
  if (grelha_new_meshes(meshes, 2, 0, &world) != GRELHA_OK)
    return failed();

  // What lies below points at x = -3, -2, ... 5?
  float org[3 * kPoints], t[kPoints], u[kPoints], v[kPoints];
  uint32_t id[kPoints];
  const float down[] = {0, 0, -1};
  for (int i = 0; i < kPoints; ++i) {
    org[3 * i] = (float)i - 3.5f;
    org[3 * i + 1] = .25f;
    org[3 * i + 2] = 9;
  }
  grelha_rays rays = {
      .count = kPoints, .org = org, .org_stride = 12, .dir = down, .dir_stride = GRELHA_SHARED};
  const grelha_hits hits = {.t = t, .id = id, .u = u, .v = v};
  grelha_surface at[kPoints];
  if (grelha_closest(world, &rays, &hits, 0) != GRELHA_OK ||
      grelha_surfaces(world, &rays, &hits, at, 0) != GRELHA_OK)
    return failed();

  // Directions by Vogel's spiral over the disc below the sky, each for all points at once.
  int open[kPoints] = {0};
  uint8_t blocked[kPoints];
  for (int k = 0; k < kDirections; ++k) {
    const float r = sqrtf(((float)k + .5f) / kDirections), turn = 2.3999632f * (float)k;
    const float dir[] = {r * cosf(turn), r * sinf(turn), sqrtf(1 - r * r)};
    rays.dir = dir;
    if (grelha_start(at, kPoints, dir, GRELHA_SHARED, org) != GRELHA_OK ||
        grelha_occluded(world, &rays, blocked, 0) != GRELHA_OK)
      return failed();
    for (int i = 0; i < kPoints; ++i)
      open[i] += !blocked[i];
  }
  for (int i = 0; i < kPoints; ++i)
    printf("x %4.1f: %.2f of the sky\n", at[i].point[0], (double)open[i] / kDirections);
  grelha_free(world);
  return 0;
}
