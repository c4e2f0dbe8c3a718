// Points: inside or outside, what is closest, how far.
#include <stdlib.h>

#include "check.h"
#include "shapes.h"

/// Of 16 bytes each: the middle, above, near the top, far beside; the last is no point.
static const float points[] = {0, 0, 0, 9, 0, 0, 3, 9, 0, 0, .75f, 9, 5, 4, 0, 9, NAN, 0, 0, 9};
enum { kStride = 16, kPoints = 5 };

void test_contains(void) {
  grelha_world* const cube = new_cube();
  uint8_t inside[kPoints];
  CHECK_OK(grelha_contains(cube, points, kStride, kPoints, GRELHA_CLOSED, inside, 1));
  CHECK(inside[0] == 1 && inside[1] == 0 && inside[2] == 1 && inside[3] == 0 && inside[4] == 0);
  CHECK_OK(grelha_contains(cube, NULL, 0, 0, GRELHA_CLOSED, NULL, 1));

  // more points than are asked at once
  const size_t count = ((size_t)1 << 20) + 3;
  float* const many = calloc(3 * count, sizeof *many);
  uint8_t* const answers = calloc(count, 1);
  many[3 * count - 1] = 2;
  CHECK_OK(grelha_contains(cube, many, 12, count, GRELHA_CLOSED, answers, 2));
  size_t sum = 0;
  for (size_t i = 0; i < count; ++i)
    sum += answers[i];
  CHECK(sum == count - 1 && answers[count - 1] == 0);
  free(answers);
  free(many);
  grelha_free(cube);

  grelha_world* const ball = new_ball();
  const float middle[] = {1, 2, 3, 1, 2, 99};
  CHECK_OK(grelha_contains(ball, middle, 12, 2, GRELHA_CLOSED, inside, 1));
  CHECK(inside[0] == 1 && inside[1] == 0);
  float distance[2];
  CHECK_OK(grelha_signed_distances(ball, middle, 12, 2, GRELHA_CLOSED, distance, 1));
  CHECK(distance[0] < 0 && distance[1] > 0);
  grelha_free(ball);
}

static int equal(const float* point, float x, float y, float z) {
  return point[0] == x && point[1] == y && point[2] == z;
}

void test_closest_points(void) {
  grelha_world* const cube = new_cube();
  float found[3 * kPoints], distance[kPoints];
  uint32_t id[kPoints];
  CHECK_OK(grelha_closest_points(cube, points, kStride, kPoints, INFINITY, found, distance, id, 1));
  CHECK(distance[0] == 1 && distance[1] == 2 && distance[2] == .25f && distance[3] == 5);
  CHECK(equal(found + 3, 0, 0, 1) && equal(found + 6, 0, 0, 1) && equal(found + 9, 1, 1, 0));
  CHECK(id[1] == 2 && id[2] == 2 && id[3] < kFaces);  // of both triangles there the lower
  CHECK(distance[4] == INFINITY && id[4] == GRELHA_NONE);
  // within a radius, which counts
  CHECK_OK(grelha_closest_points(cube, points, kStride, 4, 2, found, distance, id, 2));
  CHECK(distance[1] == 2 && distance[3] == INFINITY && id[3] == GRELHA_NONE);
  CHECK(equal(found + 9, 5, 4, 0));
  // each array alone
  CHECK_OK(grelha_closest_points(cube, points, kStride, 2, 9, found, NULL, NULL, 1));
  CHECK_OK(grelha_closest_points(cube, points, kStride, 2, 9, NULL, distance, NULL, 1));
  CHECK_OK(grelha_closest_points(cube, points, kStride, 2, 9, NULL, NULL, id, 1));
  CHECK_OK(grelha_closest_points(cube, points, kStride, 2, 9, NULL, NULL, NULL, 1));
  CHECK(equal(found + 3, 0, 0, 1) && distance[1] == 2 && id[1] == 2);
  grelha_free(cube);
  grelha_world* const ball = new_ball();
  const float above[] = {1, 2, 8};
  CHECK_OK(grelha_closest_points(ball, above, 12, 1, INFINITY, found, distance, id, 1));
  CHECK(equal(found, 1, 2, 5) && distance[0] == 3 && id[0] == 0);
  grelha_free(ball);
}

void test_signed_distances(void) {
  grelha_world* const cube = new_cube();
  float distance[kPoints];
  CHECK_OK(grelha_signed_distances(cube, points, kStride, 4, GRELHA_CLOSED, distance, 1));
  CHECK(distance[0] == -1 && distance[1] == 2 && distance[2] == -.25f && distance[3] == 5);
  grelha_free(cube);
  grelha_world* nothing = NULL;
  CHECK_OK(grelha_new_triangles(NULL, 12, 0, NULL, 0, 1, &nothing));
  CHECK_OK(grelha_signed_distances(nothing, points, kStride, 1, GRELHA_CLOSED, distance, 1));
  CHECK(distance[0] == INFINITY);
  grelha_free(nothing);
}

void test_inside_rules(void) {
  grelha_world* world = NULL;
  uint8_t inside[kPoints];
  float distance[kPoints];
  double number[kPoints];
  // without its last face
  CHECK_OK(grelha_new_triangles(cube_corners, 12, kCorners, cube_indices, kFaces - 1, 1, &world));
  CHECK_ERROR(grelha_contains(world, points, kStride, 1, GRELHA_CLOSED, inside, 1),
              GRELHA_NOT_CLOSED,
              "found 3 open edges, the first from vertex ");
  CHECK_ERROR(grelha_signed_distances(world, points, kStride, 1, GRELHA_NONZERO, distance, 1),
              GRELHA_NOT_CLOSED,
              "inside: expected a closed mesh");
  CHECK_OK(grelha_contains(world, points, kStride, kPoints, GRELHA_WINDING, inside, 1));
  CHECK(inside[0] == 1 && inside[1] == 0 && inside[2] == 1 && inside[3] == 0 && inside[4] == 0);
  CHECK_OK(grelha_signed_distances(world, points, kStride, 2, GRELHA_WINDING, distance, 1));
  CHECK(distance[0] == -1 && distance[1] == 2);
  CHECK_OK(grelha_contains(world, points, kStride, 1, GRELHA_ODD, inside, 1));
  CHECK_OK(grelha_winding_numbers(world, points, kStride, kPoints, 1e-6, number, 1));
  CHECK(fabs(number[0] - 11. / 12) < 1e-5 && number[1] < .1 && isnan(number[4]));
  CHECK_ERROR(grelha_winding_numbers(world, points, kStride, 1, 0, number, 1),
              GRELHA_INVALID,
              "error: expected more than 0, found 0");
  grelha_free(world);

  // each face twice
  uint32_t twice[6 * kFaces];
  memcpy(twice, cube_indices, sizeof cube_indices);
  memcpy(twice + 3 * kFaces, cube_indices, sizeof cube_indices);
  CHECK_OK(grelha_new_triangles(cube_corners, 12, kCorners, twice, 2 * kFaces, 1, &world));
  CHECK_OK(grelha_contains(world, points, kStride, 1, GRELHA_CLOSED, inside, 1));
  CHECK(inside[0] == 0);
  CHECK_OK(grelha_contains(world, points, kStride, 2, GRELHA_NONZERO, inside, 1));
  CHECK(inside[0] == 1 && inside[1] == 0);
  grelha_free(world);

  // the first face turned over
  memcpy(twice, cube_indices, sizeof cube_indices);
  twice[0] = cube_indices[1];
  twice[1] = cube_indices[0];
  CHECK_OK(grelha_new_triangles(cube_corners, 12, kCorners, twice, kFaces, 1, &world));
  CHECK_ERROR(grelha_contains(world, points, kStride, 1, GRELHA_NONZERO, inside, 1),
              GRELHA_NOT_CLOSED,
              "inside: expected an oriented mesh, found 3 inconsistent edges");
  CHECK_OK(grelha_contains(world, points, kStride, 2, GRELHA_CLOSED, inside, 1));
  CHECK(inside[0] == 1 && inside[1] == 0);
  grelha_free(world);
}

void test_mesh_check(void) {
  grelha_world* world = new_cube();
  grelha_mesh_check found;
  CHECK_OK(grelha_check_mesh(world, &found));
  CHECK(found.triangles == kFaces && found.vertices == kCorners && found.edges == 18);
  CHECK(found.open.count == 0 && found.open.id == GRELHA_NONE && found.inconsistent.count == 0);
  CHECK(found.nonmanifold.count == 0 && found.duplicate.id == GRELHA_NONE);
  grelha_free(world);

  // without the first face; the third turned over, the last the same as that before
  uint32_t faces[3 * (kFaces - 1)];
  memcpy(faces, cube_indices + 3, sizeof faces);
  faces[3] = 5;
  faces[4] = 4;
  memcpy(faces + 3 * (kFaces - 2), faces + 3 * (kFaces - 3), 3 * sizeof *faces);
  CHECK_OK(grelha_new_triangles(cube_corners, 12, kCorners, faces, kFaces - 1, 1, &world));
  CHECK_OK(grelha_check_mesh(world, &found));
  CHECK(found.open.count == 7 && found.open.id == 0 && found.open.from == 1 && found.open.to == 2);
  CHECK(found.inconsistent.count == 4 && found.inconsistent.id == 1);
  CHECK(found.nonmanifold.count == 2);
  CHECK(found.duplicate.count == 1 && found.duplicate.id == kFaces - 2);
  CHECK(found.degenerate.count == 0);
  grelha_free(world);
}
