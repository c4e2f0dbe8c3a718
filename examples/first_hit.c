// The C interface. With grelha installed:
// cc first_hit.c $(pkg-config --cflags --libs grelha-c) -o first_hit
#include <grelha.h>
#include <stdio.h>

static int failed(void) {
  fprintf(stderr, "first_hit: %s\n", grelha_last_error());
  return 1;
}

int main(void) {
  // A square of two triangles at z = -5. Each vertex is 12 bytes behind the one before.
  const float vertices[] = {-1, -1, -5, 1, -1, -5, 1, 1, -5, -1, 1, -5};
  const uint32_t indices[] = {0, 1, 2, 0, 2, 3};
  grelha_world* world;
  if (grelha_new_triangles(vertices, 12, 4, indices, 2, 0, &world) != GRELHA_OK)
    return failed();

  // Three rays from one origin: two meet the square, one passes it.
  const float org[] = {0, 0, 0}, dir[] = {.05f, .1f, -1, .1f, .05f, -1, 1, 1, -1};
  const grelha_rays rays = {
      .count = 3, .org = org, .org_stride = GRELHA_SHARED, .dir = dir, .dir_stride = 12};
  float t[3];
  uint32_t id[3];
  const grelha_hits hits = {.t = t, .id = id};
  if (grelha_closest(world, &rays, &hits, 1) != GRELHA_OK)
    return failed();
  for (int i = 0; i < 3; ++i)
    if (id[i] == GRELHA_NONE)
      printf("ray %d meets nothing\n", i);
    else
      printf("ray %d meets triangle %u at t = %g\n", i, (unsigned)id[i], t[i]);
  grelha_free(world);
  return 0;
}
