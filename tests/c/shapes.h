#ifndef TESTS_C_SHAPES_H
#define TESTS_C_SHAPES_H
// A cube and a ball whose answers are known.

#include <grelha.h>

enum { kCorners = 8, kFaces = 12 };
extern const float cube_corners[3 * kCorners];   ///< -1 to 1
extern const uint32_t cube_indices[3 * kFaces];  ///< outwards; 0 and 1: z = -1; 2 and 3: z = 1

grelha_world* new_cube(void);
/// Radius 2 around (1, 2, 3).
grelha_world* new_ball(void);

/// A ray for grelha_closest() and others.
grelha_rays one_ray(const float* org, const float* dir);

#endif
