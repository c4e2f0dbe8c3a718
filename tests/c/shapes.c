#include "shapes.h"

#include "check.h"

const float cube_corners[3 * kCorners] = {-1, -1, -1, 1, -1, -1, -1, 1, -1, 1, 1, -1,
                                          -1, -1, 1,  1, -1, 1,  -1, 1, 1,  1, 1, 1};
const uint32_t cube_indices[3 * kFaces] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                           2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};

grelha_world* new_cube(void) {
  grelha_world* cube = NULL;
  CHECK_OK(grelha_new_triangles(cube_corners, 12, kCorners, cube_indices, kFaces, 1, &cube));
  return cube;
}

grelha_world* new_ball(void) {
  const float center[] = {1, 2, 3}, radius = 2;
  grelha_world* ball = NULL;
  CHECK_OK(grelha_new_spheres(center, 12, &radius, 1, 1, &ball));
  return ball;
}

grelha_rays one_ray(const float* org, const float* dir) {
  grelha_rays ray = {.count = 1, .org = org, .dir = dir};
  return ray;
}
